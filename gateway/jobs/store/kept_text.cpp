// The text of the job that runs, or that was interrupted and may go on: kept under a name of its own, whoever
// deletes or replaces the job meanwhile. A second name of the same file, so it costs nothing while the job is
// there.

#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "gateway/jobs/store/file_source.hpp"
#include "gateway/jobs/store/job_store.hpp"
#include "gateway/jobs/store/read_ahead.hpp"
#include "gateway/jobs/store/upload_file.hpp"
#include "protocol/joblink/sha256.hpp"

namespace kinebus {
namespace {

namespace fs = std::filesystem;

/// Not yet anybody's: the start may still be refused, and then what was kept before stays.
constexpr const char* kNext = ".kept-next";

}  // namespace

fs::path JobStore::kept_of(std::string_view name) const {
  return options_.folder /
         (std::string(kKeptPrefix) + joblink::to_hex(joblink::sha256_of(std::string(name))).substr(0, 32));
}

JobStore::Opened JobStore::read_ahead(Opened source) const {
  if (!source || !options_.reads_ahead) return source;
  return std::make_unique<ReadAhead>(std::move(*source));
}

Result<std::unique_ptr<ByteSource>, StoreError> JobStore::open_to_run(std::string_view name) {
  auto source = open_job(name);
  if (!source || !writable_) return read_ahead(std::move(source));
  const fs::path next = options_.folder / kNext, job = options_.folder / name;
  std::error_code error;
  fs::remove(next, error);
  // A disk that knows no second names (FAT) gets a copy.
  if (::link(job.c_str(), next.c_str()) != 0 && errno != ENOENT)
    fs::copy_file(job, next, fs::copy_options::overwrite_existing, error);
  if (error) fs::remove(next, error);
  return read_ahead(std::move(source));
}

void JobStore::keep_what_runs(std::string_view name) {
  std::error_code error;
  const fs::path next = options_.folder / kNext, kept = kept_of(name);
  if (!fs::exists(next, error)) return;
  forget_kept();
  fs::rename(next, kept, error);
  sync_folder(options_.folder);
}

Result<std::unique_ptr<ByteSource>, StoreError> JobStore::open_kept(std::string_view name) {
  if (auto source = FileSource::open(kept_of(name)))
    return read_ahead(std::unique_ptr<ByteSource>(std::move(*source)));
  return read_ahead(open_job(name));
}

void JobStore::forget_kept() {
  std::error_code error;
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(options_.folder, error))
    if (entry.path().filename().string().starts_with(kKeptPrefix) && entry.path().filename() != kNext)
      old.push_back(entry.path());
  for (const fs::path& path : old) fs::remove(path, error);
}

}  // namespace kinebus
