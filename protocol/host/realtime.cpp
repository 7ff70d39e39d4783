#include "protocol/host/realtime.hpp"

#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>

namespace kinebus {

std::string become_realtime(int priority) {
  // Memory first: to fetch all of it takes long, and must not keep others from the processor.
  const int locked = ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
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
