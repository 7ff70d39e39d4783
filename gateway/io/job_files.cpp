#include "gateway/io/job_files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace kinebus {
namespace {
constexpr std::uint64_t kMaxJobBytes = 4ULL << 30;
constexpr std::string_view kHiddenPrefix = ".upload-";

std::string because(const std::filesystem::path& path, int error) {
  return path.string() + ": " + std::strerror(error);
}
}  // namespace

Result<std::unique_ptr<FileSource>, std::string> FileSource::open(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    return Error<std::string>(path.string() + " is a folder, not a job");
  auto source = std::make_unique<FileSource>();
  source->file_.reset(std::fopen(path.c_str(), "rbe"));
  if (!source->file_) return Error<std::string>(because(path, errno));
  source->size_ = std::filesystem::file_size(path, error);
  return source;
}

std::size_t FileSource::read(std::span<char> buffer) {
  return std::fread(buffer.data(), 1, buffer.size(), file_.get());
}

bool FileSource::rewind() {
  return std::fseek(file_.get(), 0, SEEK_SET) == 0;
}

std::string JobFolder::check_name(std::string_view name) {
  const auto bad = [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == '/' || c == '\\' || c == 0x7F;
  };
  if (name.empty() || name.size() > 200) return "a job's name has 1 to 200 characters";
  if (name.front() == '.') return "a job's name does not begin with a dot";
  if (std::any_of(name.begin(), name.end(), bad))
    return "a job's name has no slashes and no control characters";
  return {};
}

std::string JobFolder::prepare() {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) return folder_.string() + ": " + error.message();
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error))
    if (entry.path().filename().string().starts_with(kHiddenPrefix))
      std::filesystem::remove(entry.path(), error);
  return {};
}

std::vector<JobFolder::Entry> JobFolder::list() const {
  std::vector<Entry> entries;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with('.') && entry.is_regular_file(error))
      entries.push_back({name, entry.file_size(error)});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.name < b.name; });
  return entries;
}

Result<std::unique_ptr<FileSource>, std::string> JobFolder::open(std::string_view name) const {
  if (std::string broken = check_name(name); !broken.empty()) return Error<std::string>(broken);
  return FileSource::open(folder_ / name);
}

std::string JobFolder::remove(std::string_view name) {
  if (std::string broken = check_name(name); !broken.empty()) return broken;
  std::error_code error;
  if (!std::filesystem::remove(folder_ / name, error))
    return "no stored job has the name " + std::string(name);
  return {};
}

Result<JobUpload, std::string> JobUpload::begin(const JobFolder& folder, std::string_view name,
                                                std::uint64_t bytes) {
  if (std::string broken = JobFolder::check_name(name); !broken.empty()) return Error<std::string>(broken);
  if (bytes > kMaxJobBytes) return Error<std::string>("a job has at most 4 GiB");
  std::error_code error;
  const auto space = std::filesystem::space(folder.path(), error);
  if (!error && space.available < bytes + (16U << 20))
    return Error<std::string>("the disk has no room for this job");
  JobUpload upload;
  upload.final_ = folder.path() / name;
  std::string pattern = (folder.path() / (std::string(kHiddenPrefix) + "XXXXXX")).string();
  upload.fd_ = ::mkostemp(pattern.data(), O_CLOEXEC);
  if (upload.fd_ < 0) return Error<std::string>(because(folder.path(), errno));
  upload.hidden_ = pattern;
  upload.missing_ = bytes;
  return upload;
}

JobUpload::JobUpload(JobUpload&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      hidden_(std::move(other.hidden_)),
      final_(std::move(other.final_)),
      missing_(other.missing_) {}

JobUpload& JobUpload::operator=(JobUpload&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(hidden_, other.hidden_);
  std::swap(final_, other.final_);
  std::swap(missing_, other.missing_);
  return *this;
}

JobUpload::~JobUpload() {
  if (fd_ < 0) return;
  ::close(fd_);
  ::unlink(hidden_.c_str());
}

std::string JobUpload::write(std::string_view bytes) {
  missing_ -= bytes.size();
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return because(final_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return {};
}

std::string JobUpload::finish() {
  if (::fsync(fd_) != 0 || ::rename(hidden_.c_str(), final_.c_str()) != 0) return because(final_, errno);
  ::close(std::exchange(fd_, -1));
  const int folder = ::open(final_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
  return {};
}

}  // namespace kinebus
