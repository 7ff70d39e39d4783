#include "gateway/io/instance_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace kinebus {

InstanceLock::~InstanceLock() {
  for (const int fd : held_) ::close(fd);
}

std::string InstanceLock::take_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  return take(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC), folder);
}

std::string InstanceLock::take_file(const std::filesystem::path& file) {
  const std::filesystem::path lock = file.string() + ".lock";
  return take(::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600), file);
}

std::string InstanceLock::take(int fd, const std::filesystem::path& what) {
  if (fd < 0) return {};
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    ::close(fd);
    if (error == EWOULDBLOCK) return what.string() + ": another kinebusd uses it already";
    return what.string() + ": cannot be locked: " + std::strerror(error);
  }
  held_.push_back(fd);
  return {};
}

}  // namespace kinebus
