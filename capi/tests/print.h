/* What flight.c needs of its machine. */
#ifndef PRINT_H
#define PRINT_H

#include <stdint.h>

int flight(void);
void print_digest(const char *name, uint64_t digest);
int print_failure(const char *name, const char *what);
float print_nan(void);
/* Fills the stack below the caller, and says how many bytes of that have been used since: 0 where nobody can tell. */
void stack_paint(void);
unsigned stack_used(void);
/* Says so of a step, where somebody can tell. */
void print_stack(const char *name, unsigned bytes);

#endif
