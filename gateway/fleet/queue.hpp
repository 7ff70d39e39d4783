#pragma once
// The queue of jobs in PostgreSQL: its rules are statements here and constraints in the schema (schema.cpp).
// Every change names the job, the gateway and the attempt that it is about: who comes late changes nothing.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/fleet/database.hpp"
#include "gateway/fleet/job.hpp"
#include "gateway/fleet/machine_view.hpp"

namespace kinebus::fleet {

class Queue {
 public:
  /// What a job needs; an empty text or a nozzle of 0: any.
  struct Order {
    std::string name{};
    std::string kind{};
    std::string material{};
    double nozzle_mm = 0;
    int priority = 0;
    int copies = 1;
  };
  struct Listed {
    std::int64_t id = 0;
    int priority = 0;
    std::string name{}, state{}, gateway{}, words{};
  };
  struct Seen {
    MachineView view{};
    double seen_s = 0;  ///< ago
  };
  struct Totals {
    std::int64_t queued = 0, assigned = 0, started = 0, over = 0;
  };
  /// What a monitor asks for: of all jobs, and none for itself.
  struct Numbers {
    std::map<std::string, std::int64_t> jobs{};  ///< by state, the ones that there are
    std::int64_t begun = 0;                      ///< starts that a gateway's history has: never fewer
    double oldest_waiting_s = 0;                 ///< since it was added; 0: none waits
  };

  explicit Queue(std::string where) : database_(std::move(where)) {}

  /// Makes what is missing of the schema.
  void init();

  // For people.
  /// The text is stored once, whoever adds it how often. Returns the jobs' ids.
  std::vector<std::int64_t> add(std::string_view text, const Order& order);
  /// Cancels what nobody has yet; who has it is told to. False: no such job, or it is over.
  bool cancel(std::int64_t job);
  /// An operator's word that the job has not started and never will where it is: it is queued again.
  /// `because` is kept. False: no such job, or no gateway has it.
  bool release(std::int64_t job, const std::string& because);
  std::vector<Listed> jobs(bool over_too, int most);
  std::vector<Seen> machines();
  Totals totals();
  Numbers numbers();

  // For agents.
  /// Job of this gateway that is not over.
  std::optional<QueuedJob> job_of(const std::string& gateway);
  /// The first that fits, if this gateway has none; nothing, too, where another agent of it was faster.
  /// `newest_run`: of the gateway's history.
  std::optional<QueuedJob> claim(const Machine& machine, std::uint64_t newest_run);
  void note_started(const std::string& gateway, const QueuedJob& job);
  void note_ended(const std::string& gateway, const QueuedJob& job, Result result, const std::string& words);
  /// Cancelled if that was asked for, else queued again.
  void note_not_run(const std::string& gateway, const QueuedJob& job);
  void next_attempt(const std::string& gateway, const QueuedJob& job);
  /// Words for people who look at the job.
  void say(const std::string& gateway, const QueuedJob& job, const std::string& words);
  std::string text(const QueuedJob& job);
  /// As one statement.
  void note_machines(const std::vector<MachineView>& views);

 private:
  Database database_;
};

}  // namespace kinebus::fleet
