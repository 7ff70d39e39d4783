#pragma once
// The jobs on the gateway: their texts as files in one folder, and what is known of them in an SQLite
// database beside them.
//
//   upload: begin -> append ... -> commit     a hidden file that takes the job's name only when all of it is
//   on the disk run:    begin_run -> end_run              history; what was under way when the gateway died
//   is "interrupted"; open_to_run -> keep_what_runs: its text stays, whoever deletes or replaces the job
//
// Power may go at any moment: a job is there whole, or as it was before. The files are the truth of what is
// stored; open() makes the database agree with them. An upload that was broken off goes on at the last byte
// known to be on the disk.
//
// Calls block on the disk: one thread beside the control loop owns the store. Times are given by the caller,
// in s since 1970.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/jobs/byte_source.hpp"
#include "gateway/jobs/store/sqlite.hpp"
#include "gateway/jobs/store/store_error.hpp"
#include "gateway/result.hpp"
#include "gateway/sentence.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

struct UploadIdentity {
  std::string name{};
  std::uint64_t size_bytes = 0;
  std::string hash{};  ///< of its text (job_hash.hpp)
  /// Nobody knows its size and hash before its end: `size_bytes` is what room is kept for, `hash` a mark.
  bool open_ended = false;
};
struct UploadProgress {
  std::uint32_t id = 0;
  std::uint64_t received_bytes = 0;
  bool stored = false;  ///< the job is in the store, nothing is to be sent
};

/// What a pre-flight found, for lists. Valid for the machine file with this fingerprint.
struct StoredPreflight {
  std::uint32_t errors = 0, warnings = 0, lines = 0;
  double motion_s = 0, dwell_s = 0;
};

enum class RunResult : std::uint8_t { kRunning, kComplete, kCancelled, kRefused, kFailed, kInterrupted };
struct StoredRun {
  std::int64_t id = 0;
  std::string name{};
  std::string hash{};
  double begun_unix_s = 0, duration_s = 0, estimate_s = 0;
  RunResult result = RunResult::kRunning;
  std::uint32_t line = 0;  ///< reached
  std::string first_error{};
  std::string said{};  ///< the same as its owner writes it, to be said in another language
};

/// What the history holds, by result.
struct RunTotals {
  struct Total {
    std::uint64_t count = 0;
    double duration_s = 0;
    double longest_s = 0;
  };
  std::array<Total, 6> by_result{};
  std::uint64_t begun = 0;  ///< since the store was made; the history forgets the oldest
  const Total& of(RunResult result) const { return by_result[static_cast<std::size_t>(result)]; }
};

/// A job that may be started now.
struct BegunJob {
  std::unique_ptr<ByteSource> text{};
  std::int64_t run = 0;  ///< in the history; 0: it cannot be written
};

struct StoredJob {
  std::string name;
  std::string hash;
  std::uint64_t size_bytes = 0;
  double stored_unix_s = 0;
  std::optional<StoredPreflight> preflight;
  std::uint32_t times_run = 0;
  std::optional<StoredRun> last_run;
  joblink::SlicerNotes notes{};
};
/// An upload that is not finished.
struct PartialUpload {
  UploadIdentity identity{};
  std::uint64_t received_bytes = 0;
  double begun_unix_s = 0;
  bool open = false;  ///< somebody is sending it
};
struct JobListing {
  std::vector<StoredJob> jobs;  ///< by name
  bool more = false;            ///< others follow
  std::vector<PartialUpload> partials;
  std::uint64_t used_bytes = 0, quota_bytes = 0, free_bytes = 0;
};

class JobStore {
 public:
  struct Options {
    std::filesystem::path folder;
    std::uint64_t quota_bytes = 16ULL << 30;
    std::uint64_t max_job_bytes = 4ULL << 30;
    /// Left free on the disk for everything else.
    std::uint64_t margin_bytes = 16ULL << 20;
    double forget_uploads_after_s = 7.0 * 24 * 3600;
    /// Texts that are to run are read by a thread of their own (ReadAhead).
    bool reads_ahead = false;
  };

  /// Never fails for what the disk holds: a damaged database is set aside and made anew from the files, a
  /// folder that cannot be written (or a full disk) gives a store that reads only, and that tries again
  /// whenever something is to be written. notes() tells of both.
  static std::unique_ptr<JobStore> open(Options options, double now_unix_s);
  ~JobStore();
  JobStore(const JobStore&) = delete;
  JobStore& operator=(const JobStore&) = delete;

  const std::vector<std::string>& notes() const { return notes_; }
  bool writable() const { return writable_; }
  const std::filesystem::path& folder() const { return options_.folder; }

  /// Empty: fine. Otherwise the rule that the name breaks. Nothing outside the folder can be reached by a
  /// name.
  static Sentence check_name(std::string_view name);

  // upload.cpp
  Result<UploadProgress, StoreError> begin_upload(const UploadIdentity& identity, bool replace,
                                                  double now_unix_s);
  /// One whose size and hash the sender does not know (HTTP). `expected_bytes`: room that is kept for it; it
  /// may take more or less. It cannot be taken up again: once nobody sends it, it is deleted.
  Result<UploadProgress, StoreError> begin_open_ended(std::string_view name, std::uint64_t expected_bytes,
                                                      bool replace, double now_unix_s);
  Result<UploadProgress, StoreError> append(std::uint32_t upload, std::uint64_t offset_bytes,
                                            std::string_view bytes);
  Result<UploadProgress, StoreError> commit(std::uint32_t upload, double now_unix_s);
  void abort(std::uint32_t upload, bool discard);
  /// Forgets a half upload that nobody is sending.
  Result<void, StoreError> discard(const UploadIdentity& identity);

  // job_store.cpp
  /// At most `max` jobs, those whose names follow `after`; half uploads with the first ones.
  Result<JobListing, StoreError> list(std::string_view after = {}, std::size_t max = 2000);
  std::optional<StoredJob> find(std::string_view name);
  Result<std::unique_ptr<ByteSource>, StoreError> open_job(std::string_view name);
  Result<std::string, StoreError> read(std::string_view name, std::uint64_t offset_bytes,
                                       std::size_t max_bytes);
  Result<void, StoreError> remove(std::string_view name);
  /// A file of the folder, written under another name (beginning with a dot): gets its own one when it is
  /// safe on the disk, and is known from now on.
  Result<void, StoreError> adopt(const std::filesystem::path& written, std::string_view name,
                                 double now_unix_s);

  // notes/job_notes.cpp
  /// One of `job`'s pictures, as find() or list() told of it. nullopt: it cannot be read any more.
  std::optional<std::string> picture(const StoredJob& job, const joblink::SlicerPicture& picture);

  // kept_text.cpp
  /// As open_job(); when the job has really begun, keep_what_runs() keeps just this text.
  Result<std::unique_ptr<ByteSource>, StoreError> open_to_run(std::string_view name);
  void keep_what_runs(std::string_view name);
  /// The text that was kept for an interrupted job of this name, else the job's.
  Result<std::unique_ptr<ByteSource>, StoreError> open_kept(std::string_view name);
  void forget_kept();

  // history.cpp
  Result<void, StoreError> save_preflight(std::string_view hash, std::string_view machine,
                                          const StoredPreflight& found);
  /// Pre-flights in lists are those of this machine file (any text that names it).
  void set_machine(std::string machine) { machine_ = std::move(machine); }
  Result<std::int64_t, StoreError> begin_run(const StoredRun& run);
  /// A job of such a name (it ends in ".once.gcode") is begun once, whoever asks how often: who manages many
  /// machines may ask again after any break. So its history must be writable.
  static bool runs_once(std::string_view name);
  /// open_to_run(), with the run in the history, on the disk, before anything of it happens: what is not in
  /// the history has not begun. The caller says by refuse_run() that the machine would not take it.
  Result<BegunJob, StoreError> begin_job(std::string_view name, double now_unix_s);
  /// The history forgets it; of a job that runs once, it keeps it: refused, after 0 s.
  void refuse_run(std::int64_t id, std::string_view name, std::string_view why, std::string_view said);
  Result<void, StoreError> end_run(std::int64_t id, RunResult result, double duration_s, double estimate_s,
                                   std::uint32_t line, std::string_view first_error,
                                   std::string_view said = {});
  /// Newest first, with ids below `before` (0: all).
  Result<std::vector<StoredRun>, StoreError> history(std::int64_t before, std::size_t max);
  Result<RunTotals, StoreError> run_totals();

 private:
  struct Upload;
  /// Notes of another reader are read anew: to be counted up when it finds more.
  static constexpr std::int64_t kNotesReader = 1;
  using Opened = Result<std::unique_ptr<ByteSource>, StoreError>;
  explicit JobStore(Options options);

  Opened read_ahead(Opened source) const;

  void open_database();
  Result<void, StoreError> make_tables();
  void agree_with_files();
  void forget_old_uploads(double now_unix_s);
  Result<void, StoreError> enter(std::string_view name, std::string_view hash, double stored_unix_s);
  Result<void, StoreError> check_room(const UploadIdentity& identity, std::uint64_t on_disk_bytes);
  std::uint64_t used_bytes() const;
  std::uint64_t promised_bytes(const UploadIdentity& but) const;
  std::vector<PartialUpload> partials();
  std::uint32_t new_upload_id() const;
  std::filesystem::path kept_of(std::string_view name) const;
  void heal();
  std::optional<StoredRun> last_run(std::string_view name);
  joblink::SlicerNotes look_for_notes(const StoredJob& job);
  void add_notes(const std::vector<StoredJob*>& unread);
  std::filesystem::path partial_of(const UploadIdentity& identity) const;
  Result<std::unique_ptr<Upload>, StoreError> reopen(const UploadIdentity& identity);
  Result<UploadProgress, StoreError> open_upload(std::unique_ptr<Upload> upload, bool replace);
  Result<void, StoreError> make_room(Upload& upload, std::uint64_t size_bytes);
  Result<void, StoreError> secure(Upload& upload);
  void forget_partial(const UploadIdentity& identity);
  Result<void, StoreError> writable_or_error();

  Options options_;
  std::optional<Database> database_;
  std::vector<std::string> notes_;
  std::string machine_;
  bool writable_ = true;
  std::vector<std::unique_ptr<Upload>> uploads_;  ///< open, the oldest first
};

}  // namespace kinebus
