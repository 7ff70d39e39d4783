// Preloaded into a program, its clocks go $KINEBUS_SLOW times slower than this machine's: QEMU's guest and
// what runs beside it have more of the processor for each second of theirs (tools/vm/run --slow). What runs
// beside may hold them for both while it is behind, through the file $KINEBUS_SLOW_CLOCK that both map, and
// sees there how far the guest has come.
#define _GNU_SOURCE
#include <fcntl.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

enum { kSecond = 1000000000 };

struct Common {
  _Atomic long long until_ns;  // CLOCK_MONOTONIC goes no farther; 0: it does
  _Atomic long long stood_ns;  // for so long all clocks have stood
  _Atomic long long guest_ns;  // the guest's processor has looked at CLOCK_MONOTONIC then; 0: never
  _Atomic long long ports_ns;  // the thread of QEMU that serves the guest's devices and timers has
};
static struct Common alone;
static struct Common* common = &alone;
static long times = 1;

__attribute__((constructor)) static void begin(void) {
  const char* const said = getenv("KINEBUS_SLOW");
  if (said != NULL && atol(said) > 1) times = atol(said);
  const char* const path = getenv("KINEBUS_SLOW_CLOCK");
  const int fd = path != NULL ? open(path, O_RDWR | O_CLOEXEC) : -1;
  if (fd < 0) return;
  void* const shared = mmap(NULL, sizeof alone, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (shared != MAP_FAILED) common = shared;
  close(fd);
}

static long long slowed(clockid_t clock) {
  struct timespec at = {0};
  syscall(SYS_clock_gettime, clock, &at);
  return ((long long)at.tv_sec * kSecond + at.tv_nsec) / times;
}

struct Held {
  long long until_ns, stood_ns;
};
// Before a clock is read, or it might be older than what it is compared with. The limit first: it is written
// last.
static struct Held held(void) {
  struct Held now;
  now.until_ns = atomic_load(&common->until_ns);
  now.stood_ns = atomic_load(&common->stood_ns);
  return now;
}

// For so long all clocks have stood, when CLOCK_MONOTONIC would be `here` without.
static long long stood_at(long long here, struct Held by) {
  return by.until_ns != 0 && here - by.stood_ns > by.until_ns ? here - by.until_ns : by.stood_ns;
}

// For one of the programs, found by its name: no clock goes beyond this of CLOCK_MONOTONIC, or beyond where
// it is already, until it is called again; 0: all go on.
void kinebus_hold_clock(long long until_ns) {
  const struct Held by = held();
  const long long here = slowed(CLOCK_MONOTONIC), stood = stood_at(here, by);
  atomic_store(&common->stood_ns, stood);
  atomic_store(&common->until_ns, until_ns == 0 || until_ns > here - stood ? until_ns : here - stood);
}

// For one of the programs, found by its name: the guest has run at this of CLOCK_MONOTONIC; 0: there is none.
long long kinebus_guest_seen(void) {
  const long long guest = atomic_load(&common->guest_ns), ports = atomic_load(&common->ports_ns);
  return guest < ports ? guest : ports;
}

// Notes that this thread has run, when it is one of QEMU's (-name debug-threads=on).
static void note_seen(long long ns) {
  static _Thread_local _Atomic long long* mine;
  static _Thread_local int known;
  if (!known) {
    char name[16] = "";
    known = 1;
    prctl(PR_GET_NAME, name);
    if (strncmp(name, "CPU ", 4) == 0) mine = &common->guest_ns;
    if (strncmp(name, "qemu-system", 11) == 0 && getpid() == gettid()) mine = &common->ports_ns;
  }
  if (mine != NULL) atomic_store(mine, ns);
}

int clock_gettime(clockid_t clock, struct timespec* at) {
  const int counts_time = clock == CLOCK_MONOTONIC || clock == CLOCK_MONOTONIC_RAW || clock == CLOCK_REALTIME;
  if (!counts_time) return (int)syscall(SYS_clock_gettime, clock, at);
  const struct Held by = held();
  const long long asked = slowed(clock);
  const long long ns = asked - stood_at(clock == CLOCK_MONOTONIC ? asked : slowed(CLOCK_MONOTONIC), by);
  if (clock == CLOCK_MONOTONIC) note_seen(ns);
  at->tv_sec = (time_t)(ns / kSecond);
  at->tv_nsec = (long)(ns % kSecond);
  return 0;
}
