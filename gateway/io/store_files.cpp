#include "gateway/io/store_files.hpp"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <system_error>

#include "gateway/jobs/store/file_source.hpp"

namespace kinebus {
namespace {

namespace fs = std::filesystem;

// Files on their way to the disk begin so: no job's name does.
constexpr std::string_view kWritten = ".serial-";

bool is_job(const fs::path& path) {
  std::error_code error;
  return JobStore::check_name(path.filename().string()).empty() &&
         fs::is_regular_file(fs::symlink_status(path, error));
}

}  // namespace

StoreFiles::StoreFiles(JobStore& store, Worker& worker, Gateway& gateway, JobLinkServer& server)
    : store_(store), worker_(worker), gateway_(gateway), server_(server), folder_(store.folder()) {
  // What a power cut left half written.
  std::error_code error;
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder_, error))
    if (entry.path().filename().string().starts_with(kWritten)) left.push_back(entry.path());
  for (const fs::path& path : left) fs::remove(path, error);
}

std::vector<SerialFiles::Entry> StoreFiles::list() {
  std::vector<Entry> entries;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_, error))
    if (is_job(entry.path()) && !written_.contains(entry.path().filename().string()))
      entries.push_back({entry.path().filename().string(), entry.file_size(error)});
  for (const auto& [name, path] : written_) entries.push_back({name, fs::file_size(path_of(name), error)});
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.name < b.name; });
  return entries;
}

Result<std::unique_ptr<ByteSource>, std::string> StoreFiles::open(std::string_view name) {
  if (const Sentence broken = JobStore::check_name(name); !broken.empty())
    return Error<std::string>(broken.english());
  const fs::path path = path_of(std::string(name));
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(path, error)))
    return Error<std::string>("no stored job has the name " + std::string(name));
  auto source = FileSource::open(path);
  if (!source) return Error<std::string>(source.error());
  return std::unique_ptr<ByteSource>(std::move(*source));
}

std::string StoreFiles::run(std::string_view name) {
  auto source = open(name);
  if (!source) return source.error();
  const auto begun = gateway_.carry_out(command::Run{std::move(*source), std::string(name)});
  if (!begun) return begun.error().words.english();
  server_.job_started(std::string(name));
  return {};
}

std::string StoreFiles::remove(std::string_view name) {
  if (const auto there = open(name); !there) return there.error();
  worker_.post([&store = store_, name = std::string(name)] { static_cast<void>(store.remove(name)); }, [] {});
  return {};
}

std::string StoreFiles::store(std::string_view name, std::string_view text) {
  if (const Sentence broken = JobStore::check_name(name); !broken.empty()) return broken.english();
  const fs::path fresh = folder_ / (std::string(kWritten) + std::to_string(next_written_++));
  const int fd = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644);
  bool written = fd >= 0;
  while (written && !text.empty()) {
    const ssize_t count = ::write(fd, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    written = count > 0;
    if (written) text.remove_prefix(static_cast<std::size_t>(count));
  }
  if (!written) {
    const std::string reason = std::strerror(errno);
    if (fd >= 0) ::close(fd);
    ::unlink(fresh.c_str());
    return folder_.string() + ": " + reason;
  }
  ::close(fd);
  // The store makes it safe against a power cut, gives it its name and takes note of it, in its own time.
  written_[std::string(name)] = fresh;
  worker_.ask([&store = store_, fresh, name = std::string(name),
               unix_s = static_cast<double>(std::time(nullptr))] { return store.adopt(fresh, name, unix_s); },
              [this, fresh, name = std::string(name)](const Result<void, StoreError>& kept) {
                if (!kept)
                  spdlog::error("{} of a print host could not be stored: {}", name,
                                kept.error().words.english());
                if (const auto there = written_.find(name); there != written_.end() && there->second == fresh)
                  written_.erase(there);
              });
  return {};
}

fs::path StoreFiles::path_of(const std::string& name) const {
  const auto fresh = written_.find(name);
  std::error_code error;
  return fresh != written_.end() && fs::exists(fresh->second, error) ? fresh->second : folder_ / name;
}

}  // namespace kinebus
