#include "vcan_tests/loop_watch/call_rules.hpp"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "vcan_tests/loop_watch/call_table.hpp"

namespace kinebus {
namespace {

/// glibc places an arena's lock at the begin of a heap, which is aligned to this size.
constexpr std::uint64_t kHeapAlignment = 64 << 20;
constexpr std::uint64_t kArenaBytes = 0x1000;

}  // namespace

CallRules::CallRules(pid_t process) : process_(process) {
  std::ifstream maps("/proc/" + std::to_string(process) + "/maps");
  bool inside = false;
  for (std::string line; std::getline(maps, line);) {
    const bool named = line.find("libc.so") != std::string::npos || line.find("libc-2") != std::string::npos;
    // What it has without a file follows at once.
    const bool anonymous = line.find('/') == std::string::npos && line.find('[') == std::string::npos;
    inside = named || (inside && anonymous);
    if (!inside) continue;
    const std::uint64_t begin = std::stoull(line, nullptr, 16);
    const std::uint64_t end = std::stoull(line.substr(line.find('-') + 1), nullptr, 16);
    if (library_begin_ == 0) library_begin_ = begin;
    library_end_ = std::max(library_end_, end);
  }
}

std::string CallRules::name_of(std::uint64_t number) {
  const CallRow* row = call_row(number);
  return row == nullptr ? "system call " + std::to_string(number) : row->name;
}

CallRules::Verdict CallRules::judge(const SystemCall& call) {
  const CallRow* found = call_row(call.number);
  const CallRow row = found == nullptr ? CallRow{call.number, "", CallRule::kNever} : *found;
  const int fd = static_cast<int>(call.arguments[0]);
  switch (row.rule) {
    case CallRule::kQuick:
      if (call.number == SYS_fcntl || call.number == SYS_ioctl) known_.erase(fd);
      return {};
    case CallRule::kTransfer: {
      const bool says =
          row.flags >= 0 && (call.arguments[static_cast<std::size_t>(row.flags)] & MSG_DONTWAIT) != 0;
      return {.refused = judge_transfer(fd, says)};
    }
    case CallRule::kClose: {
      const Descriptor closed = descriptor(fd);
      known_.erase(fd);
      return {.refused = closed.file ? "of a file: " + closed.path : ""};
    }
    case CallRule::kMap:
      return {.refused = (call.arguments[3] & MAP_ANONYMOUS) != 0 ? "" : "of a file"};
    case CallRule::kFutex:
      return judge_futex(call);
    case CallRule::kNever:
      break;
  }
  std::string why = "may wait";
  if (call.number == SYS_openat || call.number == SYS_newfstatat || call.number == SYS_unlinkat)
    why += ": " + text_at(call.arguments[1]);
  return {.refused = why};
}

std::string CallRules::judge_transfer(int fd, bool says_dont_wait) {
  const Descriptor& of = descriptor(fd);
  if (of.file) return "of a file: " + of.path;
  if (of.waits && !says_dont_wait) return "of a descriptor that waits: " + of.path;
  return "";
}

CallRules::Verdict CallRules::judge_futex(const SystemCall& call) const {
  const std::uint64_t operation = call.arguments[1] & static_cast<std::uint64_t>(FUTEX_CMD_MASK);
  if (operation != FUTEX_WAIT && operation != FUTEX_WAIT_BITSET) return {};
  const std::uint64_t address = call.arguments[0];
  if (address >= library_begin_ && address < library_end_) return {.allocator = true};
  if (address % kHeapAlignment < kArenaBytes) return {.allocator = true};
  return {.refused = "waits for another thread, which does not inherit its priority"};
}

const CallRules::Descriptor& CallRules::descriptor(int fd) {
  const auto [found, is_new] = known_.try_emplace(fd);
  if (!is_new) return found->second;
  const std::string of_process = "/proc/" + std::to_string(process_);
  const std::string link = of_process + "/fd/" + std::to_string(fd);
  struct stat status {};
  if (::stat(link.c_str(), &status) == 0)
    found->second.file = S_ISREG(status.st_mode) || S_ISDIR(status.st_mode) || S_ISBLK(status.st_mode);
  // What lies in no folder (an event, a timer) is a regular file to stat().
  std::array<char, 256> path{};
  if (const ssize_t size = ::readlink(link.c_str(), path.data(), path.size()); size > 0)
    found->second.path.assign(path.data(), static_cast<std::size_t>(size));
  if (found->second.path.rfind("anon_inode:", 0) == 0) found->second.file = false;
  if (found->second.path.rfind("socket:", 0) == 0) found->second.path = "a socket";
  std::ifstream info(of_process + "/fdinfo/" + std::to_string(fd));
  for (std::string word; info >> word;)
    if (word == "flags:") {
      unsigned flags = 0;
      info >> std::oct >> flags;
      found->second.waits = (flags & O_NONBLOCK) == 0;
      break;
    }
  return found->second;
}

std::string CallRules::text_at(std::uint64_t address) const {
  std::array<char, 200> text{};
  iovec here{text.data(), text.size() - 1};
  iovec there{reinterpret_cast<void*>(address), text.size() - 1};  // NOLINT(performance-no-int-to-ptr)
  if (::process_vm_readv(process_, &here, 1, &there, 1, 0) <= 0) return "?";
  return text.data();
}

}  // namespace kinebus
