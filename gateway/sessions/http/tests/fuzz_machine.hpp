#pragma once
// A machine for fuzz targets that nothing can start, and what the HTTP server needs around it.

#include <cstdlib>
#include <deque>
#include <functional>
#include <memory>
#include <utility>

#include "gateway/description/machine_description.hpp"
#include "gateway/sessions/http/http_server.hpp"

namespace kinebus::http {

class QueueingWorker : public Worker {
 public:
  void post(std::function<void()> work, std::function<void()> done) override {
    waiting_.emplace_back(std::move(work), std::move(done));
  }
  void run() {
    while (!waiting_.empty()) {
      const auto piece = std::move(waiting_.front());
      waiting_.pop_front();
      piece.first();
      piece.second();
    }
  }

 private:
  std::deque<std::pair<std::function<void()>, std::function<void()>>> waiting_;
};

class NoMachineFile : public MachineFilePort {
 public:
  Result<Text, Sentence> read() override { return Text{}; }
  Result<void, Sentence> write(std::string_view) override { return {}; }
};

inline void check(bool holds) {
  if (!holds) std::abort();
}

struct FuzzMachine {
  // Building these takes longer than everything else.
  inline static const MachineDescription machine = default_m1();
  inline static const auto store = JobStore::open({.folder = "/dev/null/none"}, 0);
  static Gateway& gateway() {
    static Gateway built(machine);
    return built;
  }
  QueueingWorker worker;
  NoMachineFile file;
  Control control;
  JobLinkServer link{gateway(), machine, *store, worker, file, control, {}};
  Server server{link, *store, worker, control, {.users = Users("k"), .names = {}}};

  /// Gives a connection `bytes`, `piece` at a time, and its turns until it waits for time or bytes.
  void talk(std::string_view bytes, std::size_t piece) {
    LocalTime now{0};
    const auto session = server.open(now, "http", "fuzz");
    for (int turns = 0; turns < 4000 && !session->ended(); ++turns) {
      if (!bytes.empty() && session->wants_bytes()) {
        const std::string_view given = bytes.substr(0, piece);
        bytes.remove_prefix(given.size());
        session->on_bytes(now, {reinterpret_cast<const std::uint8_t*>(given.data()), given.size()});
      }
      worker.run();
      now += std::chrono::milliseconds{1};
      if (now >= session->next_deadline()) session->on_time(now);
      check(session->next_bytes().size() < (3U << 20U));
      session->on_bytes_sent(session->next_bytes().size());
      if (bytes.empty() && session->next_deadline() > now) break;
    }
    session->on_closed(now, "the end");
    worker.run();
  }
};

}  // namespace kinebus::http
