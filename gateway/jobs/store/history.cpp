// What the store knows of runs and of pre-flights.

#include <algorithm>

#include "gateway/jobs/store/job_store.hpp"

namespace kinebus {
namespace {

constexpr const char* kRunColumns =
    "id, name, hash, begun, duration, estimate, result, line, first_error, said";
/// Runs kept; the oldest go.
constexpr std::int64_t kMaxRuns = 10'000;
constexpr std::string_view kOnceEnding = ".once.gcode";

StoredRun run_of(const Database::Statement& row) {
  StoredRun run;
  run.id = row.integer(0);
  run.name = row.text(1);
  run.hash = row.text(2);
  run.begun_unix_s = row.real(3);
  run.duration_s = row.real(4);
  run.estimate_s = row.real(5);
  run.result = static_cast<RunResult>(std::clamp<std::int64_t>(row.integer(6), 0, 5));
  run.line = static_cast<std::uint32_t>(row.integer(7));
  run.first_error = row.text(8);
  run.said = row.text(9);
  return run;
}

}  // namespace

Result<void, StoreError> JobStore::save_preflight(std::string_view hash, std::string_view machine,
                                                  const StoredPreflight& found) {
  Database::Statement insert(
      *database_,
      "INSERT OR REPLACE INTO preflights(hash, machine, errors, warnings, lines, motion_s, dwell_s)"
      " VALUES(?, ?, ?, ?, ?, ?, ?)");
  return insert.bind_blob(hash)
      .bind(machine)
      .bind(std::int64_t{found.errors})
      .bind(std::int64_t{found.warnings})
      .bind(std::int64_t{found.lines})
      .bind(found.motion_s)
      .bind(found.dwell_s)
      .finish();
}

Result<std::int64_t, StoreError> JobStore::begin_run(const StoredRun& run) {
  Database::Statement insert(
      *database_,
      "INSERT INTO runs(name, hash, begun, duration, estimate, result, line, first_error)"
      " VALUES(?, ?, ?, 0, ?, 0, 0, '')");
  const auto begun =
      insert.bind(run.name).bind_blob(run.hash).bind(run.begun_unix_s).bind(run.estimate_s).finish();
  if (!begun) return Error<StoreError>(begun.error());
  const std::int64_t id = database_->last_id();
  Database::Statement forget(*database_, "DELETE FROM runs WHERE id <= ?");
  static_cast<void>(forget.bind(id - kMaxRuns).finish());
  return id;
}

bool JobStore::runs_once(std::string_view name) {
  return name.ends_with(kOnceEnding);
}

Result<BegunJob, StoreError> JobStore::begin_job(std::string_view name, double now_unix_s) {
  auto text = open_to_run(name);
  if (!text) return Error<StoreError>(text.error());
  const bool once = runs_once(name);
  if (once && last_run(name))
    return Error<StoreError>(
        {StoreError::Kind::kName, say("%1 was started before: a job of its name runs once", name)});
  StoredRun run{.name = std::string(name), .begun_unix_s = now_unix_s};
  if (const auto job = find(name)) run.hash = job->hash;
  const auto id = begin_run(run);
  if (once && !id) return Error<StoreError>(id.error());
  return BegunJob{std::move(*text), id ? *id : 0};
}

void JobStore::refuse_run(std::int64_t id, std::string_view name, std::string_view why,
                          std::string_view said) {
  if (id == 0) return;
  if (runs_once(name)) {
    static_cast<void>(end_run(id, RunResult::kRefused, 0, 0, 0, why, said));
    return;
  }
  Database::Statement forget(*database_, "DELETE FROM runs WHERE id = ?");
  static_cast<void>(forget.bind(id).finish());
}

Result<void, StoreError> JobStore::end_run(std::int64_t id, RunResult result, double duration_s,
                                           double estimate_s, std::uint32_t line,
                                           std::string_view first_error, std::string_view said) {
  Database::Statement update(*database_,
                             "UPDATE runs SET result = ?, duration = ?, estimate = ?, line = ?, first_error "
                             "= ?, said = ? WHERE id = ?");
  return update.bind(static_cast<std::int64_t>(result))
      .bind(duration_s)
      .bind(estimate_s)
      .bind(std::int64_t{line})
      .bind(first_error)
      .bind_blob(said)
      .bind(id)
      .finish();
}

Result<std::vector<StoredRun>, StoreError> JobStore::history(std::int64_t before, std::size_t max) {
  const std::string sql =
      std::string("SELECT ") + kRunColumns + " FROM runs WHERE ?1 = 0 OR id < ?1 ORDER BY id DESC LIMIT ?2";
  Database::Statement rows(*database_, sql.c_str());
  rows.bind(before).bind(static_cast<std::int64_t>(std::min<std::size_t>(max, 1000)));
  std::vector<StoredRun> runs;
  while (rows.step()) runs.push_back(run_of(rows));
  if (const auto ok = rows.error(); !ok) return Error<StoreError>(ok.error());
  return runs;
}

Result<RunTotals, StoreError> JobStore::run_totals() {
  RunTotals totals;
  Database::Statement rows(
      *database_, "SELECT result, COUNT(*), SUM(duration), MAX(id), MAX(duration) FROM runs GROUP BY result");
  while (rows.step()) {
    const auto result = std::clamp<std::int64_t>(rows.integer(0), 0, 5);
    totals.by_result[static_cast<std::size_t>(result)] = {static_cast<std::uint64_t>(rows.integer(1)),
                                                          rows.real(2), rows.real(4)};
    totals.begun = std::max(totals.begun, static_cast<std::uint64_t>(rows.integer(3)));
  }
  if (const auto ok = rows.error(); !ok) return Error<StoreError>(ok.error());
  return totals;
}

std::optional<StoredRun> JobStore::last_run(std::string_view name) {
  const std::string sql =
      std::string("SELECT ") + kRunColumns + " FROM runs WHERE name = ? ORDER BY id DESC LIMIT 1";
  Database::Statement row(*database_, sql.c_str());
  row.bind(name);
  if (!row.step()) return std::nullopt;
  return run_of(row);
}

}  // namespace kinebus
