#include "gateway/jobs/store/job_store.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <system_error>
#include <utility>

#include "gateway/jobs/store/file_source.hpp"
#include "gateway/jobs/store/upload_file.hpp"
#include "protocol/joblink/job_hash.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

namespace fs = std::filesystem;
constexpr const char* kDatabaseName = ".jobs.sqlite";
constexpr std::size_t kPiece = 1U << 20;
/// Room for a database of its own, before one is tried.
constexpr std::size_t kProbe = 256U << 10;

/// What tells a file from the one that was entered: size and time of the last change.
struct FileMark {
  std::uint64_t size_bytes = 0;
  std::int64_t changed_ns = 0;
  double changed_unix_s = 0;
};

std::optional<FileMark> mark_of(const fs::path& path) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return std::nullopt;
  const auto ns = static_cast<std::int64_t>(found.st_mtim.tv_sec) * 1'000'000'000 + found.st_mtim.tv_nsec;
  return FileMark{static_cast<std::uint64_t>(found.st_size), ns, static_cast<double>(ns) * 1e-9};
}

std::optional<std::string> hash_of_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  joblink::JobHash sum;
  std::string piece(kPiece, '\0');
  while (in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    sum.add(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
  }
  if (!in.eof()) return std::nullopt;
  return sum.finish();
}

/// From five columns beginning with `column`.
std::optional<StoredPreflight> preflight_of(const Database::Statement& row, int column) {
  if (row.null(column)) return std::nullopt;
  return StoredPreflight{
      static_cast<std::uint32_t>(row.integer(column)), static_cast<std::uint32_t>(row.integer(column + 1)),
      static_cast<std::uint32_t>(row.integer(column + 2)), row.real(column + 3), row.real(column + 4)};
}

Error<StoreError> no_such_job(std::string_view name) {
  return Error<StoreError>({StoreError::Kind::kNoSuchJob, say("no stored job has the name %1", name)});
}

}  // namespace

Sentence JobStore::check_name(std::string_view name) {
  const auto bad = [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == '/' || c == '\\' || c == 0x7F;
  };
  if (name.empty() || name.size() > 200) return say("a job's name has 1 to 200 bytes");
  if (name.front() == '.') return say("a job's name does not begin with a dot");
  if (std::any_of(name.begin(), name.end(), bad))
    return say("a job's name has no slashes and no control characters");
  if (!is_plain(name))
    return say("a job's name is text in UTF-8, without control characters and marks of direction");
  return {};
}

JobStore::JobStore(Options options) : options_(std::move(options)) {}
JobStore::~JobStore() = default;

std::unique_ptr<JobStore> JobStore::open(Options options, double now_unix_s) {
  std::unique_ptr<JobStore> store(new JobStore(std::move(options)));
  std::error_code error;
  fs::create_directories(store->options_.folder, error);
  if (error || ::access(store->options_.folder.c_str(), W_OK) != 0) {
    store->writable_ = false;
    store->notes_.push_back(store->options_.folder.string() + ": jobs cannot be stored here: " +
                            (error ? error.message() : std::string(std::strerror(errno))));
  }
  store->open_database();
  store->agree_with_files();
  store->forget_old_uploads(now_unix_s);
  return store;
}

void JobStore::open_database() {
  const fs::path path = options_.folder / kDatabaseName;
  for (int attempt = 0; writable_ && attempt < 2; ++attempt) {
    auto opened = Database::open(path);
    if (opened) {
      database_.emplace(std::move(*opened));
      const bool sound = database_->sound();
      const auto made = sound ? make_tables() : Result<void, StoreError>();
      if (sound && made) return;
      if (sound && made.error().kind != StoreError::Kind::kDisk) {
        writable_ = false;
        notes_.push_back(made.error().words);
        break;
      }
      database_.reset();
    } else if (opened.error().kind != StoreError::Kind::kDisk) {
      writable_ = false;
      notes_.push_back(opened.error().words);
      break;
    }
    std::error_code error;
    fs::rename(path, options_.folder / (std::string(kDatabaseName) + ".damaged"), error);
    fs::remove(options_.folder / (std::string(kDatabaseName) + "-journal"), error);
    notes_.emplace_back(
        "the job store's database was damaged: it is kept as .jobs.sqlite.damaged, its history is lost, the "
        "jobs themselves are not");
  }
  if (database_) return;
  if (auto memory = Database::open(":memory:")) {
    database_.emplace(std::move(*memory));
    static_cast<void>(make_tables());
  }
}

Result<void, StoreError> JobStore::make_tables() {
  // A database of an older gateway has runs without it; refused where it is there, or where no table is yet.
  static_cast<void>(database_->run("ALTER TABLE runs ADD COLUMN said BLOB"));
  // The same of half uploads: those of an older gateway are not listed, and expire.
  static_cast<void>(database_->run("ALTER TABLE uploads ADD COLUMN name TEXT"));
  static_cast<void>(database_->run("ALTER TABLE uploads ADD COLUMN hash BLOB"));
  // One older still has another hash: the texts are hashed anew, the pre-flights are forgotten.
  if (!database_->run("BEGIN IMMEDIATE;"
                      "ALTER TABLE runs RENAME COLUMN sha256 TO hash;"
                      "ALTER TABLE jobs RENAME COLUMN sha256 TO hash; DELETE FROM jobs;"
                      "ALTER TABLE preflights RENAME COLUMN sha256 TO hash; DELETE FROM preflights;"
                      "COMMIT;"))
    static_cast<void>(database_->run("ROLLBACK"));
  auto made = database_->run(
      "BEGIN IMMEDIATE;"
      "CREATE TABLE IF NOT EXISTS jobs(name TEXT PRIMARY KEY, hash BLOB NOT NULL, size INTEGER NOT NULL,"
      " changed_ns INTEGER NOT NULL, stored REAL NOT NULL);"
      "CREATE TABLE IF NOT EXISTS preflights(hash BLOB NOT NULL, machine TEXT NOT NULL, errors INTEGER,"
      " warnings INTEGER, lines INTEGER, motion_s REAL, dwell_s REAL, PRIMARY KEY(hash, machine));"
      "CREATE TABLE IF NOT EXISTS notes(hash BLOB PRIMARY KEY, reader INTEGER NOT NULL, found BLOB NOT NULL);"
      "CREATE TABLE IF NOT EXISTS uploads(partial TEXT PRIMARY KEY, size INTEGER NOT NULL, secured INTEGER "
      "NOT NULL,"
      " begun REAL NOT NULL, name TEXT, hash BLOB);"
      "CREATE TABLE IF NOT EXISTS runs(id INTEGER PRIMARY KEY AUTOINCREMENT, name TEXT NOT NULL, hash BLOB "
      "NOT NULL,"
      " begun REAL NOT NULL, duration REAL NOT NULL, estimate REAL NOT NULL, result INTEGER NOT NULL,"
      " line INTEGER NOT NULL, first_error TEXT NOT NULL, said BLOB);"
      "CREATE INDEX IF NOT EXISTS runs_by_name ON runs(name, id);"
      // Who was running when the gateway ended was interrupted.
      "UPDATE runs SET result = 5, first_error = CASE first_error WHEN '' THEN 'the gateway ended while the "
      "job ran'"
      " ELSE first_error END WHERE result = 0;"
      "COMMIT;");
  return made;
}

Result<void, StoreError> JobStore::enter(std::string_view name, std::string_view hash, double stored_unix_s) {
  const auto mark = mark_of(options_.folder / name);
  if (!mark) return no_such_job(name);
  Database::Statement insert(*database_,
                             "INSERT OR REPLACE INTO jobs(name, hash, size, changed_ns, stored)"
                             " VALUES(?, ?, ?, ?, ?)");
  return insert.bind(name)
      .bind_blob(hash)
      .bind(static_cast<std::int64_t>(mark->size_bytes))
      .bind(mark->changed_ns)
      .bind(stored_unix_s)
      .finish();
}

/// Files that came, went or changed without the database's knowledge: after a power cut, or by hand.
void JobStore::agree_with_files() {
  std::map<std::string, FileMark> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(options_.folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!check_name(name).empty()) continue;
    if (const auto mark = mark_of(entry.path())) files[name] = *mark;
  }
  // One step for the disk, however many files there are.
  static_cast<void>(database_->run("BEGIN IMMEDIATE"));
  std::vector<std::string> gone;
  {
    Database::Statement rows(*database_, "SELECT name, size, changed_ns FROM jobs");
    while (rows.step()) {
      const auto found = files.find(rows.text(0));
      if (found == files.end()) {
        gone.push_back(rows.text(0));
      } else if (static_cast<std::int64_t>(found->second.size_bytes) == rows.integer(1) &&
                 found->second.changed_ns == rows.integer(2)) {
        files.erase(found);
      }
    }
  }
  for (const std::string& name : gone) {
    Database::Statement remove(*database_, "DELETE FROM jobs WHERE name = ?");
    static_cast<void>(remove.bind(name).finish());
  }
  for (const auto& [name, mark] : files)
    if (const auto hash = hash_of_file(options_.folder / name))
      static_cast<void>(enter(name, *hash, mark.changed_unix_s));
  static_cast<void>(database_->run("DELETE FROM notes WHERE hash NOT IN (SELECT hash FROM jobs)"));
  static_cast<void>(database_->run("COMMIT"));
}

std::uint64_t JobStore::used_bytes() const {
  std::uint64_t used = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(options_.folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool kept = name.starts_with(kKeptPrefix);
    if (name.starts_with('.') && !name.starts_with(kPartialPrefix) && !kept) continue;
    // What is kept is the job itself under a second name, while that is there.
    if (kept && fs::hard_link_count(entry.path(), error) > 1) continue;
    if (const auto mark = mark_of(entry.path())) used += mark->size_bytes;
  }
  return used;
}

/// The disk may have room again, the folder may be there now.
void JobStore::heal() {
  std::error_code error;
  fs::create_directories(options_.folder, error);
  const fs::path probe = options_.folder / ".probe";
  std::ofstream out(probe, std::ios::binary);
  out << std::string(kProbe, ' ') << std::flush;
  const bool room = out.good();
  out.close();
  fs::remove(probe, error);
  if (!room) return;
  database_.reset();
  writable_ = true;
  open_database();
  agree_with_files();
}

Result<void, StoreError> JobStore::writable_or_error() {
  if (!writable_) heal();
  if (writable_) return {};
  return Error<StoreError>(
      {StoreError::Kind::kReadOnly, say("%1 cannot be written", options_.folder.string())});
}

Result<JobListing, StoreError> JobStore::list(std::string_view after, std::size_t max) {
  JobListing listing;
  Database::Statement rows(
      *database_,
      "SELECT j.name, j.hash, j.size, j.stored, p.errors, p.warnings, p.lines, p.motion_s, p.dwell_s,"
      " (SELECT COUNT(*) FROM runs r WHERE r.name = j.name), n.found"
      " FROM jobs j LEFT JOIN preflights p ON p.hash = j.hash AND p.machine = ?"
      " LEFT JOIN notes n ON n.hash = j.hash AND n.reader = ? WHERE j.name > ?"
      " ORDER BY j.name LIMIT ?");
  std::vector<bool> read;
  rows.bind(machine_).bind(kNotesReader).bind(after).bind(static_cast<std::int64_t>(max) + 1);
  while (rows.step()) {
    listing.more = listing.jobs.size() == max;
    if (listing.more) continue;
    StoredJob job;
    job.name = rows.text(0);
    job.hash = rows.text(1);
    job.size_bytes = static_cast<std::uint64_t>(rows.integer(2));
    job.stored_unix_s = rows.real(3);
    job.preflight = preflight_of(rows, 4);
    job.times_run = static_cast<std::uint32_t>(rows.integer(9));
    read.push_back(!rows.null(10) && job.notes.ParseFromString(rows.text(10)));
    listing.jobs.push_back(std::move(job));
  }
  if (const auto ok = rows.error(); !ok) return Error<StoreError>(ok.error());
  for (StoredJob& job : listing.jobs)
    if (job.times_run > 0) job.last_run = last_run(job.name);
  std::vector<StoredJob*> unread;
  for (std::size_t i = 0; i < read.size(); ++i)
    if (!read[i]) unread.push_back(&listing.jobs[i]);
  add_notes(unread);
  if (after.empty()) listing.partials = partials();
  listing.used_bytes = used_bytes();
  listing.quota_bytes = options_.quota_bytes;
  std::error_code error;
  listing.free_bytes = fs::space(options_.folder, error).available;
  if (error) listing.free_bytes = 0;
  return listing;
}

std::optional<StoredJob> JobStore::find(std::string_view name) {
  Database::Statement row(
      *database_,
      "SELECT j.hash, j.size, j.changed_ns, j.stored, p.errors, p.warnings, p.lines, p.motion_s, p.dwell_s,"
      " n.found FROM jobs j LEFT JOIN preflights p ON p.hash = j.hash AND p.machine = ?"
      " LEFT JOIN notes n ON n.hash = j.hash AND n.reader = ? WHERE j.name = ?");
  row.bind(machine_).bind(kNotesReader).bind(name);
  if (!check_name(name).empty() || !row.step()) return std::nullopt;
  const auto mark = mark_of(options_.folder / name);
  if (!mark || mark->changed_ns != row.integer(2) ||
      static_cast<std::int64_t>(mark->size_bytes) != row.integer(1))
    return std::nullopt;
  StoredJob job;
  job.name = name;
  job.hash = row.text(0);
  job.size_bytes = mark->size_bytes;
  job.stored_unix_s = row.real(3);
  job.preflight = preflight_of(row, 4);
  const bool read = !row.null(9) && job.notes.ParseFromString(row.text(9));
  static_cast<void>(row.finish());
  if (!read) add_notes({&job});
  return job;
}

Result<std::unique_ptr<ByteSource>, StoreError> JobStore::open_job(std::string_view name) {
  if (Sentence broken = check_name(name); !broken.empty())
    return Error<StoreError>({StoreError::Kind::kName, broken});
  if (!mark_of(options_.folder / name)) return no_such_job(name);
  auto source = FileSource::open(options_.folder / name);
  if (!source) return Error<StoreError>({StoreError::Kind::kDisk, Sentence::verbatim(source.error())});
  return std::move(*source);
}

Result<std::string, StoreError> JobStore::read(std::string_view name, std::uint64_t offset_bytes,
                                               std::size_t max_bytes) {
  if (Sentence broken = check_name(name); !broken.empty())
    return Error<StoreError>({StoreError::Kind::kName, broken});
  const auto mark = mark_of(options_.folder / name);
  if (!mark) return no_such_job(name);
  std::string text;
  if (offset_bytes >= mark->size_bytes) return text;
  text.resize(static_cast<std::size_t>(std::min<std::uint64_t>(max_bytes, mark->size_bytes - offset_bytes)));
  std::ifstream in(options_.folder / name, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(offset_bytes));
  if (!in.read(text.data(), static_cast<std::streamsize>(text.size())))
    return Error<StoreError>(disk_error(options_.folder / name, errno));
  return text;
}

Result<void, StoreError> JobStore::remove(std::string_view name) {
  if (Sentence broken = check_name(name); !broken.empty())
    return Error<StoreError>({StoreError::Kind::kName, broken});
  if (!mark_of(options_.folder / name)) return no_such_job(name);
  // Before anything else is written: on a full disk this is what makes room.
  if (::unlink((options_.folder / name).c_str()) != 0)
    return Error<StoreError>(disk_error(options_.folder / name, errno));
  sync_folder(options_.folder);
  if (!writable_) heal();
  Database::Statement remove(*database_, "DELETE FROM jobs WHERE name = ?");
  return remove.bind(name).finish();
}

Result<void, StoreError> JobStore::adopt(const fs::path& written, std::string_view name, double now_unix_s) {
  if (Sentence broken = check_name(name); !broken.empty())
    return Error<StoreError>({StoreError::Kind::kName, broken});
  const fs::path path = options_.folder / name;
  if (const auto mark = mark_of(written)) {
    auto room = check_room({std::string(name), mark->size_bytes, {}}, 0);
    if (!room && room.error().kind == StoreError::Kind::kQuota) {
      ::unlink(written.c_str());
      return room;
    }
  }
  const int fd = ::open(written.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) return no_such_job(name);
  const bool safe = ::fsync(fd) == 0;
  ::close(fd);
  if (!safe || ::rename(written.c_str(), path.c_str()) != 0) {
    const StoreError failed = disk_error(path, errno);
    ::unlink(written.c_str());
    return Error<StoreError>(failed);
  }
  sync_folder(options_.folder);
  const auto hash = hash_of_file(path);
  if (!hash) return Error<StoreError>(disk_error(path, errno));
  return enter(name, *hash, now_unix_s);
}

}  // namespace kinebus
