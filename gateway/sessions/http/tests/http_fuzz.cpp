// Any bytes on HTTP connections, in pieces of any length: nothing may crash, hang or grow without bound. The
// same bytes as a form give the same parts however they are cut.

#include <cstdlib>
#include <deque>
#include <span>
#include <string>

#include "gateway/description/machine_description.hpp"
#include "gateway/sessions/http/http_server.hpp"
#include "gateway/sessions/http/multipart.hpp"

namespace kinebus::http {
namespace {

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

void check(bool holds) {
  if (!holds) std::abort();
}

std::string parts(std::string_view text, std::size_t piece) {
  Multipart form("B");
  std::string story;
  for (std::size_t at = 0; at < text.size(); at += piece) {
    form.add(text.substr(at, piece));
    check(form.held_bytes() < Multipart::kMaxPartHead + piece + 100);
    for (bool more = false; !more;) {
      const Multipart::Step step = form.next();
      more = step == Multipart::Step::kMore || step == Multipart::Step::kEnd || step == Multipart::Step::kBad;
      if (step == Multipart::Step::kPart) story += "\n" + form.name() + "\t" + form.file_name().value_or("-");
      if (step == Multipart::Step::kData) story += form.data();
      if (step == Multipart::Step::kBad) return story + "\nbad";
    }
  }
  return story;
}

}  // namespace
}  // namespace kinebus::http

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus;
  static const MachineDescription machine = default_m1();
  static const auto store = JobStore::open({.folder = "/dev/null/none"}, 0);
  // Building it takes longer than everything else, and nothing here can start it.
  static Gateway gateway(machine);
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string whole = http::parts(text, size + 1);
  if (whole.find("\nbad") == std::string::npos) http::check(http::parts(text, 7) == whole);

  http::QueueingWorker worker;
  http::NoMachineFile file;
  Control control;
  JobLinkServer link(gateway, machine, *store, worker, file, control, {});
  http::Server server(link, *store, worker, control, {.key = "k", .names = {}});
  LocalTime now{0};
  for (const std::size_t piece : {size + 1, std::size_t{61}}) {
    const auto session = server.open(now, "http", "fuzz");
    std::size_t at = 0;
    // A connection that has been told all has its turns until it waits for time or bytes.
    for (int turns = 0; turns < 4000 && !session->ended(); ++turns) {
      if (at < size && session->wants_bytes()) {
        const std::size_t count = std::min(piece, size - at);
        session->on_bytes(now, {data + at, count});
        at += count;
      }
      worker.run();
      now += std::chrono::milliseconds{1};
      if (now >= session->next_deadline()) session->on_time(now);
      http::check(session->next_bytes().size() < (1U << 20U));
      session->on_bytes_sent(session->next_bytes().size());
      if (at >= size && session->next_deadline() > now) break;
    }
    session->on_closed(now, "the end");
    worker.run();
  }
  http::check(control.clients().empty());
  return 0;
}
