#pragma once

#include <csignal>
#include <thread>
#include <utility>

namespace kinebus {

/// A thread that takes no signals but those of its own faults: the others are the main thread's.
template <typename Work>
std::thread quiet_thread(Work work) {
  sigset_t all, before;
  sigfillset(&all);
  for (const int own_fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) sigdelset(&all, own_fault);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(std::move(work));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace kinebus
