// Uploads: begun, resumed at any byte, secured on the way, checked whole, and given their name in one step.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <random>
#include <system_error>
#include <utility>

#include "gateway/jobs/store/job_store.hpp"
#include "gateway/jobs/store/upload_file.hpp"
#include "protocol/host/write_all.hpp"
#include "protocol/joblink/sha256.hpp"

namespace kinebus {
namespace {

namespace fs = std::filesystem;
/// After so many bytes they are made safe: what a power cut costs at most.
constexpr std::uint64_t kSecureEvery = 16ULL << 20;
/// Uploads that are open at once, of all clients; the one that began first goes back to the disk alone.
constexpr std::size_t kMaxOpen = 64;
constexpr std::size_t kReadPiece = 1U << 20;
/// Room that an upload of unknown size takes at once, where there is so much.
constexpr std::uint64_t kRoomStep = 8ULL << 20;

Error<StoreError> fail(StoreError::Kind kind, Sentence words) {
  return Error<StoreError>({kind, std::move(words)});
}

Error<StoreError> not_open() {
  return fail(StoreError::Kind::kOrder,
              say("this upload is not open: begin it again, it goes on where it was"));
}

bool same(const UploadIdentity& a, const UploadIdentity& b) {
  return a.name == b.name && (a.size_bytes == b.size_bytes || a.open_ended) && a.hash == b.hash;
}

/// What stands for the hash of an upload that has none yet: no other upload has it.
std::string random_mark() {
  std::random_device random;
  std::string mark(joblink::kJobHashBytes, '\0');
  for (char& byte : mark) byte = static_cast<char>(random());
  return mark;
}

}  // namespace

JobStore::Upload::~Upload() {
  if (fd >= 0) ::close(fd);
}

fs::path JobStore::partial_of(const UploadIdentity& identity) const {
  joblink::Sha256 sum;
  sum.add(identity.hash);
  sum.add(std::to_string(identity.open_ended ? 0 : identity.size_bytes) + "/");
  sum.add(identity.name);
  return options_.folder / (std::string(kPartialPrefix) + joblink::to_hex(sum.finish()).substr(0, 32));
}

void JobStore::forget_partial(const UploadIdentity& identity) {
  const fs::path partial = partial_of(identity);
  ::unlink(partial.c_str());
  Database::Statement remove(*database_, "DELETE FROM uploads WHERE partial = ?");
  static_cast<void>(remove.bind(partial.filename().string()).finish());
}

void JobStore::forget_old_uploads(double now_unix_s) {
  std::error_code error;
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(options_.folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kPartialPrefix)) continue;
    Database::Statement row(*database_, "SELECT begun FROM uploads WHERE partial = ?");
    row.bind(name);
    const bool open = std::any_of(uploads_.begin(), uploads_.end(), [&](const auto& upload) {
      return partial_of(upload->identity).filename() == name;
    });
    if (open) continue;
    if (!row.step() || row.real(0) < now_unix_s - options_.forget_uploads_after_s)
      old.push_back(entry.path());
  }
  for (const fs::path& path : old) {
    ::unlink(path.c_str());
    Database::Statement remove(*database_, "DELETE FROM uploads WHERE partial = ?");
    static_cast<void>(remove.bind(path.filename().string()).finish());
  }
}

/// What open uploads have been promised and have not brought yet.
std::uint64_t JobStore::promised_bytes(const UploadIdentity& but) const {
  std::uint64_t promised = 0;
  for (const auto& upload : uploads_)
    if (!same(upload->identity, but)) promised += upload->identity.size_bytes - upload->received_bytes;
  return promised;
}

Result<void, StoreError> JobStore::check_room(const UploadIdentity& identity, std::uint64_t on_disk_bytes) {
  const std::uint64_t promised = promised_bytes(identity);
  std::uint64_t used = used_bytes() - on_disk_bytes + promised;
  // The job that is replaced makes room, once.
  const bool replaced_by_another = std::any_of(uploads_.begin(), uploads_.end(), [&](const auto& upload) {
    return upload->identity.name == identity.name && !same(upload->identity, identity);
  });
  if (const auto present = find(identity.name); present && !replaced_by_another)
    used -= std::min(used, present->size_bytes);
  if (identity.size_bytes > options_.max_job_bytes)
    return fail(StoreError::Kind::kQuota, say("a job has at most %1 MiB", options_.max_job_bytes >> 20));
  if (used + identity.size_bytes > options_.quota_bytes)
    return fail(StoreError::Kind::kQuota,
                say("the store's quota of %1 MiB has no room for this job: delete others first",
                    options_.quota_bytes >> 20));
  std::error_code error;
  const auto space = fs::space(options_.folder, error);
  if (!error && space.available + on_disk_bytes < promised + identity.size_bytes + options_.margin_bytes)
    return fail(StoreError::Kind::kDiskFull, say("the disk has no room for this job: delete others first"));
  return {};
}

/// No client can name another's by counting.
std::uint32_t JobStore::new_upload_id() const {
  std::random_device random;
  for (;;) {
    const std::uint32_t id = random();
    if (id != 0 && std::none_of(uploads_.begin(), uploads_.end(), [&](const auto& u) { return u->id == id; }))
      return id;
  }
}

std::vector<PartialUpload> JobStore::partials() {
  std::vector<PartialUpload> found;
  Database::Statement rows(
      *database_, "SELECT name, hash, size, begun FROM uploads WHERE name IS NOT NULL ORDER BY begun");
  while (rows.step()) {
    PartialUpload partial{{rows.text(0), static_cast<std::uint64_t>(rows.integer(2)), rows.text(1)}};
    partial.begun_unix_s = rows.real(3);
    std::error_code error;
    const auto size = fs::file_size(partial_of(partial.identity), error);
    partial.received_bytes = error ? 0 : size;
    partial.open = std::any_of(uploads_.begin(), uploads_.end(),
                               [&](const auto& upload) { return same(upload->identity, partial.identity); });
    found.push_back(std::move(partial));
  }
  return found;
}

Result<void, StoreError> JobStore::discard(const UploadIdentity& identity) {
  if (auto ok = writable_or_error(); !ok) return ok;
  if (std::any_of(uploads_.begin(), uploads_.end(),
                  [&](const auto& u) { return same(u->identity, identity); }))
    return fail(StoreError::Kind::kBusy, say("a client is sending this upload"));
  if (std::error_code error; !fs::exists(partial_of(identity), error))
    return fail(StoreError::Kind::kNoSuchJob, say("no upload of this name is half done"));
  forget_partial(identity);
  return {};
}

/// The bytes of an earlier attempt that are surely there, or an empty file.
Result<std::unique_ptr<JobStore::Upload>, StoreError> JobStore::reopen(const UploadIdentity& identity) {
  auto upload = std::make_unique<Upload>();
  upload->identity = identity;
  const fs::path partial = partial_of(identity);
  upload->fd = ::open(partial.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (upload->fd < 0) return Error<StoreError>(disk_error(partial, errno));
  Database::Statement row(*database_, "SELECT secured FROM uploads WHERE partial = ?");
  row.bind(partial.filename().string());
  const std::uint64_t secured = row.step() ? static_cast<std::uint64_t>(row.integer(0)) : 0;
  std::string piece(kReadPiece, '\0');
  while (upload->received_bytes < secured) {
    const auto wanted =
        static_cast<std::size_t>(std::min<std::uint64_t>(kReadPiece, secured - upload->received_bytes));
    const ssize_t count = ::read(upload->fd, piece.data(), wanted);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    upload->sum.add(std::string_view(piece).substr(0, static_cast<std::size_t>(count)));
    upload->received_bytes += static_cast<std::uint64_t>(count);
  }
  upload->secured_bytes = upload->received_bytes;
  if (::ftruncate(upload->fd, static_cast<off_t>(upload->received_bytes)) != 0 ||
      ::lseek(upload->fd, static_cast<off_t>(upload->received_bytes), SEEK_SET) < 0)
    return Error<StoreError>(disk_error(partial, errno));
  return upload;
}

Result<UploadProgress, StoreError> JobStore::begin_upload(const UploadIdentity& identity, bool replace,
                                                          double now_unix_s) {
  if (Sentence broken = check_name(identity.name); !broken.empty())
    return fail(StoreError::Kind::kName, broken);
  if (identity.hash.size() != joblink::kJobHashBytes)
    return fail(StoreError::Kind::kChecksum, say("an upload names the XXH3 of its job: 16 bytes"));
  if (auto ok = writable_or_error(); !ok) return Error<StoreError>(ok.error());
  forget_old_uploads(now_unix_s);
  if (const auto present = find(identity.name)) {
    if (present->hash == identity.hash && present->size_bytes == identity.size_bytes)
      return UploadProgress{0, identity.size_bytes, true};
    if (!replace)
      return fail(StoreError::Kind::kName, say("another job has the name %1 already", identity.name));
  }
  const auto open = std::find_if(uploads_.begin(), uploads_.end(),
                                 [&](const auto& u) { return same(u->identity, identity); });
  if (open != uploads_.end()) {
    // The same client after a broken link, or a second one with the same file: the older conversation's id is
    // void.
    Upload& upload = **open;
    upload.id = new_upload_id();
    upload.replace = replace;
    return UploadProgress{upload.id, upload.received_bytes, false};
  }
  struct stat there {};
  const bool begun = ::stat(partial_of(identity).c_str(), &there) == 0;
  if (auto ok = check_room(identity, begun ? static_cast<std::uint64_t>(there.st_size) : 0); !ok)
    return Error<StoreError>(ok.error());
  auto upload = reopen(identity);
  if (!upload) return Error<StoreError>(upload.error());
  Database::Statement insert(
      *database_,
      "INSERT OR REPLACE INTO uploads(partial, size, secured, begun, name, hash) VALUES(?, ?, ?, ?, ?, ?)");
  if (auto ok = insert.bind(partial_of(identity).filename().string())
                    .bind(static_cast<std::int64_t>(identity.size_bytes))
                    .bind(static_cast<std::int64_t>((*upload)->secured_bytes))
                    .bind(now_unix_s)
                    .bind(identity.name)
                    .bind_blob(identity.hash)
                    .finish();
      !ok)
    return Error<StoreError>(ok.error());
  return open_upload(std::move(*upload), replace);
}

Result<UploadProgress, StoreError> JobStore::open_upload(std::unique_ptr<Upload> upload, bool replace) {
  if (uploads_.size() >= kMaxOpen) {
    static_cast<void>(secure(*uploads_.front()));
    uploads_.erase(uploads_.begin());
  }
  upload->id = new_upload_id();
  upload->replace = replace;
  const UploadProgress progress{upload->id, upload->received_bytes, false};
  uploads_.push_back(std::move(upload));
  return progress;
}

Result<UploadProgress, StoreError> JobStore::begin_open_ended(std::string_view name,
                                                              std::uint64_t expected_bytes, bool replace,
                                                              double now_unix_s) {
  if (Sentence broken = check_name(name); !broken.empty()) return fail(StoreError::Kind::kName, broken);
  if (auto ok = writable_or_error(); !ok) return Error<StoreError>(ok.error());
  // Those that nobody sends any more among them: no row of the database knows them.
  forget_old_uploads(now_unix_s);
  if (!replace && find(name))
    return fail(StoreError::Kind::kName, say("another job has the name %1 already", name));
  const UploadIdentity identity{std::string(name), expected_bytes, random_mark(), true};
  if (auto ok = check_room(identity, 0); !ok) return Error<StoreError>(ok.error());
  auto upload = reopen(identity);
  if (!upload) return Error<StoreError>(upload.error());
  return open_upload(std::move(*upload), replace);
}

/// For an upload that brings more than was expected.
Result<void, StoreError> JobStore::make_room(Upload& upload, std::uint64_t size_bytes) {
  const std::uint64_t before = upload.identity.size_bytes;
  Result<void, StoreError> ok;
  for (const std::uint64_t ahead : {kRoomStep, std::uint64_t{0}}) {
    upload.identity.size_bytes = size_bytes + ahead;
    ok = check_room(upload.identity, upload.received_bytes);
    if (ok) return ok;
  }
  upload.identity.size_bytes = before;
  return ok;
}

/// All bytes received are on the disk, and the database knows it.
Result<void, StoreError> JobStore::secure(Upload& upload) {
  if (::fdatasync(upload.fd) != 0) return Error<StoreError>(disk_error(partial_of(upload.identity), errno));
  upload.secured_bytes = upload.received_bytes;
  Database::Statement update(*database_, "UPDATE uploads SET secured = ? WHERE partial = ?");
  return update.bind(static_cast<std::int64_t>(upload.secured_bytes))
      .bind(partial_of(upload.identity).filename().string())
      .finish();
}

Result<UploadProgress, StoreError> JobStore::append(std::uint32_t id, std::uint64_t offset_bytes,
                                                    std::string_view bytes) {
  const auto found =
      std::find_if(uploads_.begin(), uploads_.end(), [&](const auto& u) { return u->id == id; });
  if (found == uploads_.end()) return not_open();
  Upload& upload = **found;
  if (offset_bytes != upload.received_bytes)
    return fail(StoreError::Kind::kOrder,
                say("the next byte of this upload is %1, not %2", upload.received_bytes, offset_bytes));
  const bool too_many = bytes.size() > upload.identity.size_bytes - upload.received_bytes;
  if (too_many && upload.identity.open_ended) {
    if (auto ok = make_room(upload, upload.received_bytes + bytes.size()); !ok)
      return Error<StoreError>(ok.error());
  } else if (too_many) {
    return fail(StoreError::Kind::kOrder, say("more bytes than were announced"));
  }
  if (!write_all(upload.fd, bytes)) {
    const StoreError error = disk_error(partial_of(upload.identity), errno);
    // A piece that is there in part is taken back: the upload goes on at this piece when there is room.
    if (::ftruncate(upload.fd, static_cast<off_t>(upload.received_bytes)) != 0 ||
        ::lseek(upload.fd, static_cast<off_t>(upload.received_bytes), SEEK_SET) < 0)
      uploads_.erase(found);
    return Error<StoreError>(error);
  }
  upload.sum.add(bytes);
  upload.received_bytes += bytes.size();
  if (upload.received_bytes - upload.secured_bytes >= kSecureEvery)
    if (auto ok = secure(upload); !ok) return Error<StoreError>(ok.error());
  return UploadProgress{id, upload.received_bytes, false};
}

Result<UploadProgress, StoreError> JobStore::commit(std::uint32_t id, double now_unix_s) {
  const auto found =
      std::find_if(uploads_.begin(), uploads_.end(), [&](const auto& u) { return u->id == id; });
  if (found == uploads_.end()) return not_open();
  Upload& upload = **found;
  UploadIdentity identity = upload.identity;
  if (identity.open_ended) {
    upload.identity.size_bytes = identity.size_bytes = upload.received_bytes;
  } else if (upload.received_bytes != identity.size_bytes) {
    return fail(StoreError::Kind::kOrder,
                say("%1 bytes of the job have not come yet", identity.size_bytes - upload.received_bytes));
  }
  if (!upload.replace && find(identity.name))
    return fail(StoreError::Kind::kName, say("another job has the name %1 already", identity.name));
  const std::string hash = upload.sum.finish();
  if (!identity.open_ended && hash != identity.hash) {
    uploads_.erase(found);
    forget_partial(identity);
    return fail(
        StoreError::Kind::kChecksum,
        say("the bytes that came are not those that were announced (XXH3 differs): send the job again"));
  }
  const fs::path partial = partial_of(identity);
  const bool stored =
      ::fsync(upload.fd) == 0 && ::rename(partial.c_str(), (options_.folder / identity.name).c_str()) == 0;
  const int error = errno;
  uploads_.erase(found);
  if (!stored) return Error<StoreError>(disk_error(partial, error));
  sync_folder(options_.folder);
  if (auto ok = database_->run("BEGIN IMMEDIATE"); !ok) return Error<StoreError>(ok.error());
  auto entered = enter(identity.name, hash, now_unix_s);
  Database::Statement remove(*database_, "DELETE FROM uploads WHERE partial = ?");
  if (entered) entered = remove.bind(partial.filename().string()).finish();
  if (entered) entered = database_->run("COMMIT");
  if (!entered) {
    static_cast<void>(database_->run("ROLLBACK"));
    return Error<StoreError>(entered.error());
  }
  return UploadProgress{0, identity.size_bytes, true};
}

void JobStore::abort(std::uint32_t id, bool discard) {
  const auto found =
      std::find_if(uploads_.begin(), uploads_.end(), [&](const auto& u) { return u->id == id; });
  if (found == uploads_.end()) return;
  const UploadIdentity identity = (*found)->identity;
  discard = discard || identity.open_ended;
  if (!discard) static_cast<void>(secure(**found));
  uploads_.erase(found);
  if (discard) forget_partial(identity);
}

}  // namespace kinebus
