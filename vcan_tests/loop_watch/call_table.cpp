#include "vcan_tests/loop_watch/call_table.hpp"

#include <sys/syscall.h>

#include <algorithm>
#include <iterator>

namespace kinebus {
namespace {

constexpr CallRow kRows[] = {
    // The loop's own place to wait.
    {SYS_epoll_pwait, "epoll_pwait", CallRule::kQuick},
#ifdef SYS_epoll_wait
    {SYS_epoll_wait, "epoll_wait", CallRule::kQuick},
#endif
    {SYS_epoll_ctl, "epoll_ctl", CallRule::kQuick},
    {SYS_timerfd_settime, "timerfd_settime", CallRule::kQuick},
    {SYS_clock_gettime, "clock_gettime", CallRule::kQuick},
    {SYS_getrusage, "getrusage", CallRule::kQuick},
    {SYS_getrandom, "getrandom", CallRule::kQuick},
    {SYS_getpid, "getpid", CallRule::kQuick},
    {SYS_gettid, "gettid", CallRule::kQuick},
    {SYS_getuid, "getuid", CallRule::kQuick},
    {SYS_geteuid, "geteuid", CallRule::kQuick},
    {SYS_getgid, "getgid", CallRule::kQuick},
    {SYS_getegid, "getegid", CallRule::kQuick},
    {SYS_sched_getscheduler, "sched_getscheduler", CallRule::kQuick},
    {SYS_sched_getaffinity, "sched_getaffinity", CallRule::kQuick},
    {SYS_rt_sigprocmask, "rt_sigprocmask", CallRule::kQuick},
    {SYS_rt_sigaction, "rt_sigaction", CallRule::kQuick},
    {SYS_rt_sigreturn, "rt_sigreturn", CallRule::kQuick},
    {SYS_restart_syscall, "restart_syscall", CallRule::kQuick},
    {SYS_fcntl, "fcntl", CallRule::kQuick},
    {SYS_socket, "socket", CallRule::kQuick},
    {SYS_setsockopt, "setsockopt", CallRule::kQuick},
    {SYS_getsockopt, "getsockopt", CallRule::kQuick},
    {SYS_getsockname, "getsockname", CallRule::kQuick},
    {SYS_getpeername, "getpeername", CallRule::kQuick},
    {SYS_shutdown, "shutdown", CallRule::kQuick},
    {SYS_eventfd2, "eventfd2", CallRule::kQuick},
    {SYS_io_submit, "io_submit", CallRule::kQuick},
    {SYS_ioctl, "ioctl", CallRule::kQuick},
    {SYS_brk, "brk", CallRule::kQuick},
    {SYS_munmap, "munmap", CallRule::kQuick},
    {SYS_mremap, "mremap", CallRule::kQuick},
    {SYS_mprotect, "mprotect", CallRule::kQuick},
    {SYS_madvise, "madvise", CallRule::kQuick},
    // A thread for what may wait.
    {SYS_clone, "clone", CallRule::kQuick},
    {SYS_clone3, "clone3", CallRule::kQuick},
    {SYS_mmap, "mmap", CallRule::kMap},
    {SYS_futex, "futex", CallRule::kFutex},
    {SYS_close, "close", CallRule::kClose},
    {SYS_read, "read", CallRule::kTransfer},
    {SYS_write, "write", CallRule::kTransfer},
    {SYS_readv, "readv", CallRule::kTransfer},
    {SYS_writev, "writev", CallRule::kTransfer},
    {SYS_accept, "accept", CallRule::kTransfer},
    {SYS_accept4, "accept4", CallRule::kTransfer},
    {SYS_connect, "connect", CallRule::kTransfer},
    {SYS_sendto, "sendto", CallRule::kTransfer, 3},
    {SYS_recvfrom, "recvfrom", CallRule::kTransfer, 3},
    {SYS_sendmsg, "sendmsg", CallRule::kTransfer, 2},
    {SYS_recvmsg, "recvmsg", CallRule::kTransfer, 2},
    {SYS_sendmmsg, "sendmmsg", CallRule::kTransfer, 3},
    {SYS_recvmmsg, "recvmmsg", CallRule::kTransfer, 3},
    // What is met most often where something is wrong, by name; all others are refused by number.
    {SYS_openat, "openat", CallRule::kNever},
    {SYS_newfstatat, "newfstatat", CallRule::kNever},
    {SYS_fstat, "fstat", CallRule::kNever},
    {SYS_lseek, "lseek", CallRule::kNever},
    {SYS_fsync, "fsync", CallRule::kNever},
    {SYS_fdatasync, "fdatasync", CallRule::kNever},
    {SYS_unlinkat, "unlinkat", CallRule::kNever},
    {SYS_getdents64, "getdents64", CallRule::kNever},
    {SYS_ppoll, "ppoll", CallRule::kNever},
    {SYS_nanosleep, "nanosleep", CallRule::kNever},
    {SYS_clock_nanosleep, "clock_nanosleep", CallRule::kNever},
    {SYS_wait4, "wait4", CallRule::kNever},
#ifdef SYS_open
    {SYS_open, "open", CallRule::kNever},
    {SYS_poll, "poll", CallRule::kNever},
    {SYS_unlink, "unlink", CallRule::kNever},
    {SYS_rename, "rename", CallRule::kNever},
    {SYS_mkdir, "mkdir", CallRule::kNever},
    {SYS_access, "access", CallRule::kNever},
    {SYS_readlink, "readlink", CallRule::kNever},
#endif
};

}  // namespace

const CallRow* call_row(std::uint64_t number) {
  const CallRow* row =
      std::find_if(std::begin(kRows), std::end(kRows), [&](const CallRow& r) { return r.number == number; });
  return row == std::end(kRows) ? nullptr : row;
}

}  // namespace kinebus
