# find_package(slung REQUIRED PATHS dist NO_DEFAULT_PATH), then target_link_libraries(program PRIVATE slung::slung).
# SLUNG_MACHINE is host, cortex-m4f or cortex-m7; left out, it follows CMAKE_SYSTEM_PROCESSOR.
if(NOT DEFINED SLUNG_MACHINE)
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "cortex-m7")
        set(SLUNG_MACHINE cortex-m7)
    elseif(CMAKE_SYSTEM_NAME STREQUAL "Generic")
        set(SLUNG_MACHINE cortex-m4f)
    else()
        set(SLUNG_MACHINE host)
    endif()
endif()
set(_slung_object "${CMAKE_CURRENT_LIST_DIR}/${SLUNG_MACHINE}/slung.o")
if(NOT EXISTS "${_slung_object}")
    set(slung_FOUND FALSE)
    set(slung_NOT_FOUND_MESSAGE "${_slung_object} is missing: cargo xtask object ${SLUNG_MACHINE}")
    return()
endif()
if(NOT TARGET slung::slung)
    add_library(slung::slung INTERFACE IMPORTED)
    set_target_properties(slung::slung PROPERTIES
        INTERFACE_INCLUDE_DIRECTORIES "${CMAKE_CURRENT_LIST_DIR}/include"
        INTERFACE_LINK_LIBRARIES "${_slung_object}")
endif()
