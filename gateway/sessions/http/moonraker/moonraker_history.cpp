// Moonraker's API: the history of jobs, and the queue that Kinebus does not have.

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/sessions/http/moonraker/moonraker.hpp"

namespace kinebus::http {
namespace {

/// As many as the store gives at once.
constexpr std::size_t kMostRuns = 1000;

const char* result_word(RunResult result) {
  switch (result) {
    case RunResult::kRunning:
      return "in_progress";
    case RunResult::kComplete:
      return "completed";
    case RunResult::kCancelled:
      return "cancelled";
    case RunResult::kInterrupted:
      return "interrupted";
    case RunResult::kRefused:
    case RunResult::kFailed:
      return "error";
  }
  return "error";
}

/// `store`: tells whether the job's text is still the one that ran.
Json run_json(JobStore& store, const StoredRun& run) {
  const auto job = store.find(run.name);
  const bool runs = run.result == RunResult::kRunning;
  return {{"job_id", std::to_string(run.id)},
          {"exists", job && job->hash == run.hash},
          {"filename", run.name},
          {"start_time", run.begun_unix_s},
          {"end_time", runs ? Json(nullptr) : Json(run.begun_unix_s + run.duration_s)},
          {"total_duration", run.duration_s},
          {"print_duration", run.duration_s},
          {"status", result_word(run.result)},
          {"metadata", Json::object()},
          {"auxiliary_data", Json::array()},
          {"user", nullptr}};
}

void with_runs(const Call& call, std::function<Json(JobStore&, std::vector<StoredRun>)> make) {
  call.caller.beside(
      [make = std::move(make)](JobStore& store) {
        auto runs = store.history(0, kMostRuns);
        if (!runs)
          return Result<Json, RpcError>(Error<RpcError>(RpcError{500, runs.error().words.english()}));
        return Result<Json, RpcError>(make(store, std::move(*runs)));
      },
      [call](Result<Json, RpcError> made) { call.then(std::move(made)); });
}

void list_history(const Call& call) {
  const double limit = call.number("limit", 50), start = call.number("start", 0);
  const double since = call.number("since", 0), before = call.number("before", 1e18);
  const bool ascending = call.text("order") == "asc";
  with_runs(call, [=](JobStore& store, std::vector<StoredRun> runs) {
    if (ascending) std::reverse(runs.begin(), runs.end());
    Json jobs = Json::array();
    double count = 0;
    for (const StoredRun& run : runs) {
      if (run.begun_unix_s <= since || run.begun_unix_s >= before) continue;
      if (count >= start && static_cast<double>(jobs.size()) < limit) jobs.push_back(run_json(store, run));
      ++count;
    }
    return Json{{"count", static_cast<std::uint64_t>(count)}, {"jobs", std::move(jobs)}};
  });
}

/// Of the runs that the history holds: it forgets the oldest.
void totals(const Call& call) {
  call.caller.beside([](JobStore& store) { return store.run_totals(); },
                     [call](const Result<RunTotals, StoreError>& totals) {
                       if (!totals) return call.fail(500, totals.error().words.english());
                       std::uint64_t count = 0;
                       double time = 0, longest = 0;
                       for (const RunTotals::Total& total : totals->by_result) {
                         count += total.count;
                         time += total.duration_s;
                         longest = std::max(longest, total.longest_s);
                       }
                       call.done({{"job_totals",
                                   {{"total_jobs", count},
                                    {"total_time", time},
                                    {"total_print_time", time},
                                    {"longest_job", longest},
                                    {"longest_print", longest}}},
                                  {"auxiliary_totals", Json::array()}});
                     });
}

void one_job(const Call& call) {
  call.caller.beside(
      [uid = call.text("uid")](JobStore& store) {
        const auto runs = store.history(0, kMostRuns);
        if (!runs) return Json(nullptr);
        for (const StoredRun& run : *runs)
          if (std::to_string(run.id) == uid) return run_json(store, run);
        return Json(nullptr);
      },
      [call](Json run) {
        if (run.is_null()) return call.fail(404, "the history has no job '" + call.text("uid") + "'");
        call.done({{"job", std::move(run)}});
      });
}

/// There is no queue: nothing is in it, and nothing of it will begin.
void job_queue(const Call& call) {
  call.done({{"queued_jobs", Json::array()}, {"queue_state", "paused"}});
}

}  // namespace

void newest_run(Caller& caller, std::function<void(Json)> then) {
  caller.beside(
      [](JobStore& store) {
        const auto runs = store.history(0, 1);
        return !runs || runs->empty() ? Json(nullptr) : run_json(store, runs->front());
      },
      std::move(then));
}

std::span<const Method> moonraker_history_methods() {
  static constexpr std::array kMethods{
      Method{"server.history.list", "GET", "server/history/list", list_history},
      Method{"server.history.totals", "GET", "server/history/totals", totals},
      Method{"server.history.get_job", "GET", "server/history/job", one_job},
      Method{"server.job_queue.status", "GET", "server/job_queue/status", job_queue},
  };
  return kMethods;
}

}  // namespace kinebus::http
