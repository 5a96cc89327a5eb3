/* flight.c on an emulated Cortex-M4F: vectors, the FPU switched on, text by semihosting, and no library. */
#include "print.h"

#include <stddef.h>

extern uint32_t stack_top;
void reset(void);

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*handlers[15])(void);
} vectors = {&stack_top, {reset}};

static int host_call(int operation, uintptr_t argument) {
    register int r0 __asm__("r0") = operation;
    register uintptr_t r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static void write(const char *text) { host_call(4, (uintptr_t)text); }

void print_digest(const char *name, uint64_t digest) {
    char hex[18];
    for (int i = 0; i < 16; ++i) hex[i] = "0123456789abcdef"[digest >> (60 - 4 * i) & 15];
    hex[16] = '\n';
    hex[17] = 0;
    write(name);
    write(" ");
    write(hex);
}

int print_failure(const char *name, const char *what) {
    write(name);
    write(": ");
    write(what);
    write("\n");
    return 1;
}

float print_nan(void) {
    const union {
        uint32_t bits;
        float number;
    } nan = {0x7fc00000u};
    return nan.number;
}

enum { PAINTED = 16384 };

/* Whoever paints or looks must not be painted over: from 64 bytes below its own frame. */
static volatile unsigned char *below(void) { return (volatile unsigned char *)__builtin_frame_address(0) - 64; }

static volatile unsigned char *painted;

__attribute__((noinline)) void stack_paint(void) {
    painted = below();
    for (int i = 1; i <= PAINTED; ++i) painted[-i] = 0xa5;
}

__attribute__((noinline)) unsigned stack_used(void) {
    int used = PAINTED;
    while (used > 0 && painted[-used] == 0xa5) --used;
    return (unsigned)used + 64u;
}

void print_stack(const char *name, unsigned bytes) {
    char digits[6];
    for (int i = 4; i >= 0; --i, bytes /= 10) digits[i] = (char)('0' + bytes % 10);
    digits[5] = 0;
    write("stack of a step: ");
    write(name);
    write(" ");
    write(digits);
    write(" B\n");
}

/* What GCC takes for granted of any environment. */
void *memcpy(void *restrict to, const void *restrict from, size_t count) {
    unsigned char *t = to;
    for (const unsigned char *f = from; count > 0; --count) *t++ = *f++;
    return to;
}
void *memset(void *to, int value, size_t count) {
    for (unsigned char *t = to; count > 0; --count) *t++ = (unsigned char)value;
    return to;
}
void __aeabi_memcpy(void *to, const void *from, size_t count) { memcpy(to, from, count); }
void __aeabi_memcpy4(void *to, const void *from, size_t count) { memcpy(to, from, count); }
void __aeabi_memcpy8(void *to, const void *from, size_t count) { memcpy(to, from, count); }
void __aeabi_memset4(void *to, size_t count, int value) { memset(to, value, count); }
void __aeabi_memset8(void *to, size_t count, int value) { memset(to, value, count); }
void __aeabi_memclr(void *to, size_t count) { memset(to, 0, count); }
void __aeabi_memclr4(void *to, size_t count) { memset(to, 0, count); }
void __aeabi_memclr8(void *to, size_t count) { memset(to, 0, count); }

void reset(void) {
    /* Full access to coprocessors 10 and 11: the floating-point unit. */
    *(volatile uint32_t *)0xe000ed88u |= 0xfu << 20;
    __asm__ volatile("dsb\n isb");
    const int failures = flight();
    /* SYS_EXIT: stopped with a run-time error, or by the application. */
    host_call(0x18, failures ? 0x20023u : 0x20026u);
    for (;;) {
    }
}
