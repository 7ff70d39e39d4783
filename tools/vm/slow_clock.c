// Preloaded into a program, its clocks go $KINEBUS_SLOW times slower than this machine's: QEMU's guest and
// what runs beside it have more of the processor for each second of theirs (tools/vm/run --slow).
#define _GNU_SOURCE
#include <stdlib.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

enum { kSecond = 1000000000 };

static long slower(void) {
  static long times = 0;
  if (times == 0) {
    const char* const said = getenv("KINEBUS_SLOW");
    times = said != NULL && atol(said) > 1 ? atol(said) : 1;
  }
  return times;
}

int clock_gettime(clockid_t clock, struct timespec* at) {
  const long status = syscall(SYS_clock_gettime, clock, at);
  const int counts_time = clock == CLOCK_MONOTONIC || clock == CLOCK_MONOTONIC_RAW || clock == CLOCK_REALTIME;
  if (status != 0 || !counts_time) return (int)status;
  const long long ns = ((long long)at->tv_sec * kSecond + at->tv_nsec) / slower();
  at->tv_sec = (time_t)(ns / kSecond);
  at->tv_nsec = (long)(ns % kSecond);
  return 0;
}
