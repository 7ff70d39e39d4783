#pragma once
// One daemon for one set of files: taken before anything of them is opened, held until the process ends
// however it ends.

#include <filesystem>
#include <string>
#include <vector>

namespace kinebus {

class InstanceLock {
 public:
  InstanceLock() = default;
  ~InstanceLock();
  InstanceLock(const InstanceLock&) = delete;
  InstanceLock& operator=(const InstanceLock&) = delete;

  /// A folder (made where it is not there), or a file: by a file of its name and ".lock". Empty: it is this
  /// process' alone, or it is where nothing can be written, by a second daemon neither.
  std::string take_folder(const std::filesystem::path& folder);
  std::string take_file(const std::filesystem::path& file);

 private:
  std::string take(int fd, const std::filesystem::path& what);
  std::vector<int> held_;
};

}  // namespace kinebus
