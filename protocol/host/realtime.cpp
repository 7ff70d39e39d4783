#include "protocol/host/realtime.hpp"

#include <linux/capability.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <vector>

namespace kinebus {

namespace {

/// With a limit, memory that is asked for later would one day be refused instead of locked: the process would
/// end.
bool may_lock_without_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3]{};
  return ::syscall(SYS_capget, &header, data) == 0 && (data[0].effective & (1U << CAP_IPC_LOCK)) != 0;
}

constexpr std::size_t kStackBytes = 2 << 20;
/// Larger pieces get memory of their own. The most that glibc takes for it.
constexpr int kOwnMemoryFrom = 32 << 20;
constexpr int kKeep = 512 << 20;

}  // namespace

void keep_stacks_small() {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

void keep_heap(std::size_t bytes) {
  ::mallopt(M_MMAP_THRESHOLD, kOwnMemoryFrom);
  ::mallopt(M_TRIM_THRESHOLD, kKeep);
  std::vector<std::uint8_t> memory(bytes, 1);
  // Or the compiler sees that nobody reads it.
  asm volatile("" : : "r"(memory.data()) : "memory");
}

std::string become_realtime(int priority) {
  // Memory first: to fetch all of it takes long, and must not keep others from the processor.
  int locked = EPERM;
  if (may_lock_without_limit()) locked = ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
  sched_param parameters{};
  parameters.sched_priority = priority;
  std::string missing;
  if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) != 0)
    missing += std::string("SCHED_FIFO (") + std::strerror(errno) + ")";
  if (locked != 0)
    missing += std::string(missing.empty() ? "" : ", ") + "locked memory (" + std::strerror(locked) + ")";
  return missing;
}

}  // namespace kinebus
