#pragma once
// Which system calls a thread that must never wait may make.

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>

namespace kinebus {

struct SystemCall {
  std::uint64_t number = 0;
  std::array<std::uint64_t, 6> arguments{};
};

/// Judges the calls of one process's threads, as they begin: descriptors are looked up in /proc.
class CallRules {
 public:
  struct Verdict {
    std::string refused{};   ///< why; empty: it cannot block
    bool allocator = false;  ///< waits for the C library's own lock: allowed while that is short
  };

  explicit CallRules(pid_t process);

  static std::string name_of(std::uint64_t number);
  Verdict judge(const SystemCall& call);

 private:
  struct Descriptor {
    bool file = false;  ///< of a disk, as far as the kernel says
    bool waits = true;  ///< without O_NONBLOCK
    std::string path{};
  };
  const Descriptor& descriptor(int fd);
  std::string judge_transfer(int fd, bool says_dont_wait);
  Verdict judge_futex(const SystemCall& call) const;
  std::string text_at(std::uint64_t address) const;

  pid_t process_;
  std::map<int, Descriptor> known_;
  std::uint64_t library_begin_ = 0, library_end_ = 0;  ///< the C library, where the first arena's lock lies
};

}  // namespace kinebus
