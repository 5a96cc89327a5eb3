/* flight.c on a host. */
#include "print.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

void print_digest(const char *name, uint64_t digest) { printf("%s %016" PRIx64 "\n", name, digest); }

int print_failure(const char *name, const char *what) {
    fprintf(stderr, "%s: %s\n", name, what);
    return 1;
}

float print_nan(void) { return NAN; }

void stack_paint(void) {}
unsigned stack_used(void) { return 0; }
void print_stack(const char *name, unsigned bytes) {
    (void)name;
    (void)bytes;
}

int main(void) { return flight(); }
