// What slicers wrote into stored jobs, read once for each text and kept in the database.

#include <algorithm>
#include <span>

#include "gateway/jobs/store/job_store.hpp"
#include "gateway/jobs/store/notes/slicer_notes.hpp"

namespace kinebus {
namespace {

/// So many texts are looked into for one list: at 1.5 MiB each, at most a second of a slow card. The others
/// come with the next list.
constexpr std::size_t kTextsAList = 16;

}  // namespace

joblink::SlicerNotes JobStore::look_for_notes(const StoredJob& job) {
  const std::uint64_t both = kNotesHeadBytes + kNotesTailBytes;
  const bool whole = job.size_bytes <= both;
  const auto head = read(job.name, 0, whole ? both : kNotesHeadBytes);
  if (!head || whole) return head ? read_slicer_notes(*head, {}) : joblink::SlicerNotes();
  const auto tail = read(job.name, job.size_bytes - kNotesTailBytes, kNotesTailBytes);
  return read_slicer_notes(*head, tail ? *tail : std::string());
}

void JobStore::add_notes(const std::vector<StoredJob*>& unread) {
  if (unread.empty()) return;
  // One step for the disk. Where nothing can be written they are looked for again.
  static_cast<void>(database_->run("BEGIN IMMEDIATE"));
  for (StoredJob* job : std::span(unread).first(std::min(unread.size(), kTextsAList))) {
    job->notes = look_for_notes(*job);
    Database::Statement insert(*database_,
                               "INSERT OR REPLACE INTO notes(hash, reader, found) VALUES(?, ?, ?)");
    static_cast<void>(
        insert.bind_blob(job->hash).bind(kNotesReader).bind_blob(job->notes.SerializeAsString()).finish());
  }
  if (!database_->run("COMMIT")) static_cast<void>(database_->run("ROLLBACK"));
}

std::optional<std::string> JobStore::picture(const StoredJob& job, const joblink::SlicerPicture& picture) {
  const auto text = read(job.name, picture.text_offset_bytes(), picture.text_bytes());
  return text ? decode_picture(*text, picture) : std::nullopt;
}

}  // namespace kinebus
