// What goes wrong at a disk, in words, and what makes a new name last.

#include "gateway/jobs/store/upload_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace kinebus {

StoreError disk_error(const std::filesystem::path& path, int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return {StoreError::Kind::kDiskFull, say("the disk is full")};
    case EROFS:
    case EACCES:
    case EPERM:
      return {StoreError::Kind::kReadOnly,
              say("%1 cannot be written: %2", path.string(), std::strerror(error))};
    default:
      return {StoreError::Kind::kDisk, say("%1: %2", path.string(), std::strerror(error))};
  }
}

void sync_folder(const std::filesystem::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

}  // namespace kinebus
