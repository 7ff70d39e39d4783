#include "gateway/fleet/demo/child_process.hpp"

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace kinebus::fleet {
namespace {

struct Rights {
  uid_t user = 0;
  gid_t group = 0;
};

Rights rights_of(const std::string& user) {
  const passwd* const found = ::getpwnam(user.c_str());
  if (found == nullptr) throw std::runtime_error("there is no user " + user);
  return {found->pw_uid, found->pw_gid};
}

/// In the child, which has nothing but its exit status to tell by.
[[noreturn]] void become(char* const* words, int log, const Rights* rights, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  if (rights != nullptr) {
    const bool ours =
        ::setgroups(0, nullptr) == 0 && ::setgid(rights->group) == 0 && ::setuid(rights->user) == 0;
    // A change of rights has cleared it.
    if (!ours || ::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) ::_exit(1);
  }
  ::execvp(words[0], words);
  ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::string& log,
                           const std::string& user) {
  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const Rights rights = user.empty() ? Rights() : rights_of(user);
  const int fd = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (fd < 0) throw std::runtime_error(log + ": " + std::strerror(errno));
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) become(words.data(), fd, user.empty() ? nullptr : &rights, parent);
  ::close(fd);
  if (pid_ < 0) throw std::runtime_error(command.front() + " cannot be started");
}

ChildProcess::~ChildProcess() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGTERM);
  ::waitpid(pid_, nullptr, 0);
}

int ChildProcess::wait() {
  int status = 0;
  ::waitpid(std::exchange(pid_, -1), &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

}  // namespace kinebus::fleet
