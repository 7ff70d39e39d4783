#pragma once
// A folder that is gone with the test.

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace kinebus {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    // In memory where the system has that: thousands of fsync() calls would wear a disk and wait for it.
    const std::filesystem::path memory = "/dev/shm";
    const bool usable = std::filesystem::is_directory(memory) && ::access(memory.c_str(), W_OK) == 0;
    const auto parent = usable ? memory : std::filesystem::temp_directory_path();
    std::string pattern = (parent / "kinebus-test-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace kinebus
