/* What a run may take when nobody says: as many processors and as much memory as the process has,
 * which in a container or under a limit is less than the machine. */
#ifndef RECEDE_BASE_MACHINE_H
#define RECEDE_BASE_MACHINE_H

#include <stdint.h>

int rc_machine_processors(void);
uint64_t rc_machine_memory_bytes(void);

#endif
