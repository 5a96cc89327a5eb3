/* What flight.c needs of its machine. */
#ifndef PRINT_H
#define PRINT_H

#include <stdint.h>

int flight(void);
void print_digest(const char *name, uint64_t digest);
int print_failure(const char *name, const char *what);
float print_nan(void);

#endif
