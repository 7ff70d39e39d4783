#include "tools/cli/secret_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "gateway/io/tls_stream.hpp"
#include "protocol/host/write_all.hpp"

namespace kinebus {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path) {
  throw std::runtime_error(fmt::format("{}: {}", path.string(), std::strerror(errno)));
}

/// Whose it is to be, and where it is not there yet.
struct stat owner_of(const std::filesystem::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0 && ::stat(file.parent_path().c_str(), &found) != 0) fail(file);
  return found;
}

}  // namespace

SecretFile::SecretFile(const std::filesystem::path& file) : file_(std::filesystem::absolute(file)) {
  std::error_code none;
  // What a link leads to is changed, not the link.
  if (const auto real = std::filesystem::canonical(file_, none); !none) file_ = real;
  const std::filesystem::path folder = file_.parent_path();
  folder_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0) fail(folder);
  if (::flock(folder_, LOCK_EX) != 0) fail(folder);
}

SecretFile::~SecretFile() {
  ::close(folder_);
}

std::string SecretFile::read() const {
  struct stat found {};
  if (::stat(file_.c_str(), &found) != 0) {
    if (errno == ENOENT) return {};
    fail(file_);
  }
  if (std::string loose = loose_secret(file_); !loose.empty()) throw std::runtime_error(loose);
  std::ifstream in(file_, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) fail(file_);
  return std::move(text).str();
}

void SecretFile::write(std::string_view text) const {
  const struct stat owner = owner_of(file_);
  const std::filesystem::path fresh = file_.string() + ".new";
  // What another one left that ended halfway: nobody else is at work here.
  ::unlink(fresh.c_str());
  const int fd = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (fd < 0) fail(fresh);
  bool written = ::fchmod(fd, 0600) == 0;
  struct stat mine {};
  if (written && ::fstat(fd, &mine) == 0 && (mine.st_uid != owner.st_uid || mine.st_gid != owner.st_gid))
    written = ::fchown(fd, owner.st_uid, owner.st_gid) == 0;
  written = written && write_all(fd, text) && ::fsync(fd) == 0 && ::rename(fresh.c_str(), file_.c_str()) == 0;
  const int why = errno;
  ::close(fd);
  if (!written) {
    ::unlink(fresh.c_str());
    errno = why;
    fail(fresh);
  }
  ::fsync(folder_);
}

std::string read_secret(const char* prompt) {
  termios before{};
  const bool terminal = ::isatty(STDIN_FILENO) != 0 && ::tcgetattr(STDIN_FILENO, &before) == 0;
  if (terminal) {
    fmt::print(stderr, "{}", prompt);
    termios silent = before;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &silent);
  }
  std::string line;
  std::getline(std::cin, line);
  if (terminal) {
    ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before);
    fmt::print(stderr, "\n");
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

}  // namespace kinebus
