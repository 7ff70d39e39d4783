#include "gateway/jobs/store/file_source.hpp"

#include <cerrno>
#include <cstring>
#include <system_error>

namespace kinebus {

Result<std::unique_ptr<FileSource>, std::string> FileSource::open(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    return Error<std::string>(path.string() + " is a folder, not a job");
  auto source = std::make_unique<FileSource>();
  source->file_.reset(std::fopen(path.c_str(), "rbe"));
  if (!source->file_) return Error<std::string>(path.string() + ": " + std::strerror(errno));
  source->size_ = std::filesystem::file_size(path, error);
  return source;
}

std::size_t FileSource::read(std::span<char> buffer) {
  return std::fread(buffer.data(), 1, buffer.size(), file_.get());
}

bool FileSource::rewind() {
  return std::fseek(file_.get(), 0, SEEK_SET) == 0;
}

}  // namespace kinebus
