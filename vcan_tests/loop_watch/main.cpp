// kinebus-loop-watch: shows that a thread never waits but in its event loop. It follows the system calls of
// one thread (a process's main thread by its process id) until SIGINT or SIGTERM, and lets it go.
//   kinebus-loop-watch THREAD
// Prints "watching" when it has begun; at the end each call with its number and longest time, page faults,
// and what is refused. Exit status 1: something is. Each call costs the thread two changes of process.

#include <sys/ptrace.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "protocol/host/guarded_main.hpp"
#include "vcan_tests/loop_watch/call_rules.hpp"

namespace {

using namespace kinebus;
using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

long trace(__ptrace_request request, pid_t thread, long data = 0) {
  return ::ptrace(request, thread, nullptr,
                  reinterpret_cast<void*>(data));  // NOLINT(performance-no-int-to-ptr)
}

/// The allocator's lock is held for some list operations.
constexpr Milliseconds kAllocatorWaits{1.0};

/// Memory that the loop had to ask for: a page of locked memory is cleared while it waits. 1 MiB.
constexpr long kPages = 256;

volatile std::sig_atomic_t ended = 0;
void on_end(int) {
  ended = 1;
}

struct Faults {
  long minor = 0, major = 0;
};

Faults faults_of(pid_t thread) {
  std::ifstream file("/proc/" + std::to_string(thread) + "/task/" + std::to_string(thread) + "/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t after_name = text.rfind(')');
  Faults found;
  if (after_name == std::string::npos) return found;
  std::istringstream words(text.substr(after_name + 1));
  std::string word;
  // Fields 3 to 9 come before minflt, cminflt is between.
  for (int field = 3; field <= 9; ++field) words >> word;
  words >> found.minor >> word >> found.major;
  return found;
}

class Watch {
 public:
  explicit Watch(pid_t thread) : thread_(thread), rules_(thread) {}

  /// At each stop before and after a call.
  void on_call() {
    struct __ptrace_syscall_info info {};
    if (::ptrace(PTRACE_GET_SYSCALL_INFO, thread_, sizeof info, &info) <= 0) return;
    if (info.op == PTRACE_SYSCALL_INFO_ENTRY) {
      call_.number = info.entry.nr;
      for (std::size_t i = 0; i < call_.arguments.size(); ++i) call_.arguments[i] = info.entry.args[i];
      verdict_ = rules_.judge(call_);
      if (!verdict_.refused.empty()) refuse(verdict_.refused);
      inside_ = true;
      entered_ = Clock::now();
    } else if (info.op == PTRACE_SYSCALL_INFO_EXIT && inside_) {
      inside_ = false;
      const Milliseconds took = Clock::now() - entered_;
      Row& row = rows_[call_.number];
      ++row.count;
      row.longest = std::max(row.longest, took);
      if (!verdict_.allocator) return;
      ++allocator_.count;
      allocator_.longest = std::max(allocator_.longest, took);
      if (took > kAllocatorWaits) refuse("waits for the allocator's lock for more than a millisecond");
    }
  }

  /// 0: nothing is refused.
  int report() const {
    const Faults now = faults_of(thread_);
    for (const auto& [number, row] : rows_)
      std::printf("%-20s %8ld  longest %9.3f ms\n", CallRules::name_of(number).c_str(), row.count,
                  row.longest.count());
    std::printf("allocator's lock     %8ld  longest %9.3f ms\n", allocator_.count,
                allocator_.longest.count());
    const long major = now.major - before_.major;
    const long minor = now.minor - before_.minor;
    std::printf("page faults: %ld minor, %ld major\n", minor, major);
    for (const auto& [words, row] : refused_)
      std::printf("REFUSED %s, %ld times, first after %.3f s\n", words.c_str(), row.count,
                  row.longest.count() / 1e3);
    if (major > 0) std::printf("REFUSED page faults that wait for a disk\n");
    if (minor > kPages)
      std::printf("REFUSED more than %ld pages of memory that were not there before\n", kPages);
    const bool bad = !refused_.empty() || major > 0 || minor > kPages || rows_.empty();
    std::printf("%s\n", rows_.empty() ? "nothing was seen"
                        : bad         ? "the thread may wait"
                                      : "the thread waits nowhere else");
    return bad ? 1 : 0;
  }

 private:
  struct Row {
    long count = 0;
    Milliseconds longest{0};
  };
  void refuse(const std::string& why) {
    Row& row = refused_[CallRules::name_of(call_.number) + " " + why];
    if (row.count++ == 0) row.longest = Clock::now() - began_;
  }

  pid_t thread_;
  CallRules rules_;
  Faults before_ = faults_of(thread_);
  Clock::time_point began_ = Clock::now(), entered_{};
  SystemCall call_{};
  CallRules::Verdict verdict_{};
  bool inside_ = false;
  Row allocator_{};
  std::map<std::uint64_t, Row> rows_;
  std::map<std::string, Row> refused_;
};

/// Until it is asked to end or the thread is gone. False: gone.
bool follow(pid_t thread, Watch& watch) {
  bool asked = false;
  for (;;) {
    int status = 0;
    if (::waitpid(thread, &status, __WALL) < 0) {
      if (errno != EINTR) return false;
      if (ended != 0 && !asked) asked = trace(PTRACE_INTERRUPT, thread) == 0;
      continue;
    }
    if (WIFEXITED(status) || WIFSIGNALED(status)) return false;
    const int event = status >> 16;
    const int signal = WSTOPSIG(status);
    long handed = 0;
    if (signal == (SIGTRAP | 0x80))
      watch.on_call();
    else if (event == 0)
      handed = signal;
    if (ended != 0 && asked) {
      trace(PTRACE_DETACH, thread, handed);
      return true;
    }
    // A signal that came between two calls of waitpid() was not seen by it.
    if (ended != 0) asked = trace(PTRACE_INTERRUPT, thread) == 0;
    const bool group_stop = event == PTRACE_EVENT_STOP && signal != SIGTRAP;
    trace(group_stop ? PTRACE_LISTEN : PTRACE_SYSCALL, thread, handed);
  }
}

int run(int argc, char** argv) {
  const pid_t thread = argc == 2 ? std::atoi(argv[1]) : 0;
  if (thread <= 0) {
    std::fprintf(stderr, "kinebus-loop-watch THREAD\n");
    return 2;
  }
  struct sigaction action {};
  action.sa_handler = on_end;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  if (trace(PTRACE_SEIZE, thread, PTRACE_O_TRACESYSGOOD) != 0) {
    std::fprintf(stderr, "kinebus-loop-watch: thread %d: %s\n", thread, std::strerror(errno));
    return 2;
  }
  Watch watch(thread);
  trace(PTRACE_INTERRUPT, thread);
  std::printf("watching\n");
  std::fflush(stdout);
  const bool there = follow(thread, watch);
  if (!there) std::printf("the thread ended while it was watched\n");
  const int verdict = watch.report();
  return there ? verdict : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-loop-watch", [&] { return run(argc, argv); });
}
