#include "gateway/fleet/queue.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "gateway/fleet/schema.hpp"
#include "protocol/joblink/job_hash.hpp"
#include "protocol/joblink/sha256.hpp"

namespace kinebus::fleet {
namespace {

constexpr const char* kClaim = R"sql(
UPDATE jobs SET state = 'assigned', gateway = $1, attempt = attempt + 1, after_run = $5::bigint, words = '', changed = now()
WHERE id = (
  SELECT id FROM jobs WHERE state = 'queued' AND (kind = '' OR kind = $2) AND (material = '' OR material = $3)
    AND (nozzle_mm = 0 OR abs(nozzle_mm - $4::double precision) < 0.001)
  ORDER BY priority DESC, id LIMIT 1 FOR UPDATE SKIP LOCKED)
RETURNING id, name, file, (SELECT text_hash FROM files WHERE hash = file), attempt, after_run, state, cancel
)sql";

/// The rest of each statement that speaks for one start: another agent may have done it, or an operator.
constexpr const char* kThisStart =
    " changed = now() WHERE id = $1 AND gateway = $2 AND attempt = $3 AND state IN ('assigned', 'started')";
/// Of what the gateway's history says: a database that loses it in a crash is told again, so nobody waits for
/// its disk. The next claim of this gateway does, and what was written before it is on the disk with it.
constexpr const char* kToldAgain = " AND set_config('synchronous_commit', 'off', true) = 'off'";
/// Once for each ticket, whatever of its run was noted first.
constexpr const char* kBegun = " begun = begun + CASE state WHEN 'assigned' THEN 1 ELSE 0 END,";

/// Ordered by name: two agents that write the same machines must not wait for each other.
constexpr const char* kNoteMachines = R"sql(
INSERT INTO machines
SELECT name, kind, material, nozzle_mm, answers, state, words, job, progress, now()
FROM jsonb_to_recordset($1::jsonb) AS view(name text, kind text, material text, nozzle_mm double precision, answers boolean,
  state text, words text, job bigint, progress double precision)
ORDER BY name
ON CONFLICT (name) DO UPDATE SET
  kind = excluded.kind, material = excluded.material, nozzle_mm = excluded.nozzle_mm, answers = excluded.answers,
  state = excluded.state, words = excluded.words, job = excluded.job, progress = excluded.progress, seen = excluded.seen
)sql";

/// A gateway's words: a text of PostgreSQL has no zero byte, and one machine must not stand in the others'
/// way.
std::string plain(std::string words) {
  std::erase(words, '\0');
  return words;
}

std::vector<Parameter> start(const QueuedJob& job, const std::string& gateway) {
  return {job.id, gateway, job.attempt};
}

/// The columns of job_of().
QueuedJob job_in(const Rows& rows) {
  return {.id = rows.integer(0, 0),
          .name = rows.text(0, 1),
          .file_hash = rows.bytes(0, 2),
          .text_hash = rows.bytes(0, 3),
          .attempt = static_cast<int>(rows.integer(0, 4)),
          .after_run = static_cast<std::uint64_t>(rows.integer(0, 5)),
          .started = rows.text(0, 6) == "started",
          .cancel = rows.truth(0, 7)};
}

}  // namespace

void Queue::init() {
  database_.run_all(kSchema);
}

std::vector<std::int64_t> Queue::add(std::string_view text, const Order& order) {
  const std::string hash = joblink::sha256_of(text);
  database_.run(
      "INSERT INTO files(hash, text_hash, text) VALUES ($1, $2, $3) ON CONFLICT DO NOTHING",
      {Parameter::bytes(hash), Parameter::bytes(joblink::job_hash_of(text)), Parameter::bytes(text)});
  const Rows rows = database_.run(
      "INSERT INTO jobs(name, file, kind, material, nozzle_mm, priority)"
      " SELECT $1, $2::bytea, $3, $4, $5::double precision, $6::int FROM generate_series(1, $7::int) "
      "RETURNING id",
      {order.name, Parameter::bytes(hash), order.kind, order.material, order.nozzle_mm, order.priority,
       order.copies});
  std::vector<std::int64_t> ids;
  ids.reserve(static_cast<std::size_t>(rows.count()));
  for (int row = 0; row < rows.count(); ++row) ids.push_back(rows.integer(row, 0));
  return ids;
}

bool Queue::cancel(std::int64_t job) {
  return database_
             .run(
                 "UPDATE jobs SET cancel = true, changed = now(),"
                 " state = CASE state WHEN 'queued' THEN 'cancelled' ELSE state END"
                 " WHERE id = $1 AND state IN ('queued', 'assigned', 'started') RETURNING id",
                 {job})
             .count() > 0;
}

bool Queue::release(std::int64_t job, const std::string& because) {
  return database_
             .run(
                 "UPDATE jobs SET state = CASE WHEN cancel THEN 'cancelled' ELSE 'queued' END, gateway = '',"
                 " words = 'released: ' || $2, changed = now()"
                 " WHERE id = $1 AND state IN ('assigned', 'started') RETURNING id",
                 {job, because})
             .count() > 0;
}

std::vector<Queue::Listed> Queue::jobs(bool over_too, int most) {
  const Rows rows = database_.run(
      "SELECT id, priority, name, state, gateway, words FROM jobs"
      " WHERE $1 OR state IN ('queued', 'assigned', 'started')"
      " ORDER BY state = 'queued', priority DESC, id LIMIT $2",
      {over_too, most});
  std::vector<Listed> list;
  list.reserve(static_cast<std::size_t>(rows.count()));
  for (int row = 0; row < rows.count(); ++row)
    list.push_back({rows.integer(row, 0), static_cast<int>(rows.integer(row, 1)), rows.text(row, 2),
                    rows.text(row, 3), rows.text(row, 4), rows.text(row, 5)});
  return list;
}

std::vector<Queue::Seen> Queue::machines() {
  const Rows rows = database_.run(
      "SELECT name, kind, material, nozzle_mm, answers, state, words, job, progress,"
      " extract(epoch FROM now() - seen) FROM machines ORDER BY name");
  std::vector<Seen> list;
  list.reserve(static_cast<std::size_t>(rows.count()));
  for (int row = 0; row < rows.count(); ++row)
    list.push_back(
        {.view = {.machine = {rows.text(row, 0), rows.text(row, 1), rows.text(row, 2), rows.real(row, 3)},
                  .answers = rows.truth(row, 4),
                  .state = rows.text(row, 5),
                  .words = rows.text(row, 6),
                  .job = rows.integer(row, 7),
                  .progress = rows.real(row, 8)},
         .seen_s = rows.real(row, 9)});
  return list;
}

Queue::Totals Queue::totals() {
  const Rows rows = database_.run("SELECT state, count(*) FROM jobs GROUP BY state");
  Totals totals;
  for (int row = 0; row < rows.count(); ++row) {
    const std::string state = rows.text(row, 0);
    std::int64_t& total = state == "queued"     ? totals.queued
                          : state == "assigned" ? totals.assigned
                          : state == "started"  ? totals.started
                                                : totals.over;
    total += rows.integer(row, 1);
  }
  return totals;
}

Queue::Numbers Queue::numbers() {
  const Rows rows = database_.run(
      "SELECT state, count(*), sum(begun), extract(epoch FROM now() - min(added))::float8 FROM jobs GROUP BY "
      "1");
  Numbers numbers;
  for (int row = 0; row < rows.count(); ++row) {
    const std::string state = rows.text(row, 0);
    numbers.jobs[state] = rows.integer(row, 1);
    numbers.begun += rows.integer(row, 2);
    if (state == "queued") numbers.oldest_waiting_s = rows.real(row, 3);
  }
  return numbers;
}

std::optional<QueuedJob> Queue::job_of(const std::string& gateway) {
  const Rows rows = database_.run(
      "SELECT id, name, file, text_hash, attempt, after_run, state, cancel FROM jobs"
      " JOIN files ON files.hash = jobs.file WHERE gateway = $1 AND state IN ('assigned', 'started')",
      {gateway});
  if (rows.count() == 0) return std::nullopt;
  return job_in(rows);
}

std::optional<QueuedJob> Queue::claim(const Machine& machine, std::uint64_t newest_run) {
  try {
    const Rows claimed = database_.run(kClaim, {machine.name, machine.kind, machine.material,
                                                machine.nozzle_mm, static_cast<std::int64_t>(newest_run)});
    if (claimed.count() > 0) return job_in(claimed);
  } catch (const NotUnique&) {
    // Another agent of this gateway was faster.
  }
  return std::nullopt;
}

void Queue::note_started(const std::string& gateway, const QueuedJob& job) {
  database_.run(std::string("UPDATE jobs SET state = 'started',") + kBegun + kThisStart + kToldAgain,
                start(job, gateway));
}

void Queue::note_ended(const std::string& gateway, const QueuedJob& job, Result result,
                       const std::string& words) {
  auto parameters = start(job, gateway);
  parameters.emplace_back(to_word(result));
  parameters.emplace_back(words);
  database_.run(std::string("UPDATE jobs SET state = $4, words = $5,") + kBegun + kThisStart + kToldAgain,
                parameters);
}

void Queue::note_not_run(const std::string& gateway, const QueuedJob& job) {
  database_.run(std::string("UPDATE jobs SET state = CASE WHEN cancel THEN 'cancelled' ELSE 'queued' END,"
                            " gateway = '',") +
                    kThisStart,
                start(job, gateway));
}

void Queue::next_attempt(const std::string& gateway, const QueuedJob& job) {
  database_.run(std::string("UPDATE jobs SET state = 'assigned', attempt = attempt + 1,") + kThisStart,
                start(job, gateway));
}

void Queue::say(const std::string& gateway, const QueuedJob& job, const std::string& words) {
  auto parameters = start(job, gateway);
  parameters.emplace_back(words);
  database_.run(std::string("UPDATE jobs SET words = $4,") + kThisStart + " AND words <> $4", parameters);
}

std::string Queue::text(const QueuedJob& job) {
  const Rows rows =
      database_.run("SELECT text FROM files WHERE hash = $1", {Parameter::bytes(job.file_hash)});
  if (rows.count() == 0) throw DatabaseError("the text of job " + std::to_string(job.id) + " is missing");
  std::string text = rows.bytes(0, 0);
  if (joblink::sha256_of(text) != job.file_hash)
    throw DatabaseError("the text of job " + std::to_string(job.id) + " is not the one that was added");
  return text;
}

void Queue::note_machines(const std::vector<MachineView>& views) {
  using nlohmann::json;
  json all = json::array();
  for (const MachineView& view : views)
    all.push_back({{"name", view.machine.name},
                   {"kind", view.machine.kind},
                   {"material", view.machine.material},
                   {"nozzle_mm", view.machine.nozzle_mm},
                   {"answers", view.answers},
                   {"state", plain(view.state)},
                   {"words", plain(view.words)},
                   {"job", view.job},
                   {"progress", std::isfinite(view.progress) ? view.progress : 0}});
  database_.run(kNoteMachines, {all.dump(-1, ' ', false, json::error_handler_t::replace)});
}

}  // namespace kinebus::fleet
