// Stored jobs, checks and machine files as messages.
#include <algorithm>
#include <utility>

#include "gateway/sessions/messages.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

/// Of a machine file; nobody reads more of them at once.
constexpr int kMaxFileProblems = 300;
/// More are seldom half done; the oldest are shown, and the next when these are gone.
constexpr int kMaxPartials = 200;

}  // namespace

joblink::PreflightSummary to_message(const StoredPreflight& found) {
  joblink::PreflightSummary m;
  m.set_errors(found.errors);
  m.set_warnings(found.warnings);
  m.set_lines(found.lines);
  m.set_motion_s(found.motion_s);
  m.set_dwell_s(found.dwell_s);
  return m;
}

joblink::Job to_message(const StoredJob& job) {
  joblink::Job m;
  m.set_name(shown(job.name));
  m.set_hash(job.hash);
  m.set_size_bytes(job.size_bytes);
  m.set_stored_unix_s(job.stored_unix_s);
  if (job.preflight) *m.mutable_preflight() = to_message(*job.preflight);
  m.set_times_run(job.times_run);
  if (job.last_run) *m.mutable_last_run() = to_message(*job.last_run);
  if (job.notes.ByteSizeLong() > 0) *m.mutable_notes() = job.notes;
  return m;
}

joblink::JobList to_message(const JobListing& listing) {
  joblink::JobList m;
  ListRoom room;
  for (const PartialUpload& partial : listing.partials) {
    joblink::PartialUpload p;
    p.set_name(shown(partial.identity.name));
    p.set_hash(partial.identity.hash);
    p.set_size_bytes(partial.identity.size_bytes);
    p.set_received_bytes(partial.received_bytes);
    p.set_begun_unix_s(partial.begun_unix_s);
    p.set_open(partial.open);
    if (m.partial_uploads_size() >= kMaxPartials || !room.take(p)) break;
    m.mutable_partial_uploads()->Add(std::move(p));
  }
  m.set_more(listing.more);
  for (const StoredJob& stored : listing.jobs) {
    auto job = to_message(stored);
    if (!room.take(job)) {
      m.set_more(true);
      break;
    }
    m.mutable_jobs()->Add(std::move(job));
  }
  m.set_used_bytes(listing.used_bytes);
  m.set_quota_bytes(listing.quota_bytes);
  m.set_free_bytes(listing.free_bytes);
  return m;
}

joblink::JobRun to_message(const StoredRun& run) {
  joblink::JobRun m;
  m.set_id(static_cast<std::uint64_t>(run.id));
  m.set_name(shown(run.name));
  m.set_hash(run.hash);
  m.set_begun_unix_s(run.begun_unix_s);
  m.set_duration_s(run.duration_s);
  m.set_estimate_s(run.estimate_s);
  m.set_result(static_cast<joblink::JobResult>(run.result));
  m.set_line(run.line);
  m.set_first_error(shown(run.first_error));
  if (!run.said.empty() && run.said.size() <= 8 * kMaxWordsBytes)
    m.mutable_first_error_said()->ParseFromString(run.said);
  if (!m.has_first_error_said() && run.result == RunResult::kInterrupted)
    *m.mutable_first_error_said() = to_message(say("the gateway ended while the job ran"));
  return m;
}

joblink::PreflightResult to_message(const JobReport& report, const ProblemList& problems) {
  joblink::PreflightResult m;
  joblink::PreflightSummary& summary = *m.mutable_summary();
  summary.set_errors(static_cast<std::uint32_t>(problems.errors()));
  summary.set_warnings(static_cast<std::uint32_t>(problems.warnings()));
  summary.set_lines(report.lines);
  summary.set_motion_s(report.motion_s);
  summary.set_dwell_s(report.dwell_s);
  m.set_moves(report.moves);
  m.set_pauses(report.pauses);
  m.set_heat_waits(report.heat_waits);
  ListRoom room;
  for (const Problem& p : problems.all()) {
    joblink::JobProblem out;
    out.set_error(p.severity == Problem::Severity::kError);
    out.set_line(p.line);
    out.set_column(p.column);
    out.set_words(shown(p.words));
    *out.mutable_said() = to_message(p.words);
    if (!room.take(out)) break;
    m.mutable_problems()->Add(std::move(out));
  }
  return m;
}

joblink::MachineFileCheck to_message(const MachineFileErrors& errors) {
  joblink::MachineFileCheck m;
  ListRoom room;
  for (const MachineFileError& error : errors) {
    auto p = problem(joblink::ERROR_BAD_VALUE, error.key,
                     error.found.empty() ? say("missing") : say("found %1", error.found), error.expected);
    p.set_line(error.line);
    if (m.problems_size() >= kMaxFileProblems || !room.take(p)) {
      m.set_more(static_cast<std::uint32_t>(errors.size()) - static_cast<std::uint32_t>(m.problems_size()));
      break;
    }
    m.mutable_problems()->Add(std::move(p));
  }
  return m;
}

}  // namespace kinebus
