#pragma once
// The job link's server with a simulated machine behind it and clients before it, all in memory and virtual
// time.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gateway/jobs/store/tests/temporary_folder.hpp"
#include "gateway/machine/tests/machine_rig.hpp"
#include "gateway/sessions/job_link_server.hpp"
#include "protocol/joblink/client.hpp"
#include "protocol/joblink/job_hash.hpp"

namespace kinebus {

/// Does what was posted when the test says so.
class LaterWorker : public Worker {
 public:
  void post(std::function<void()> work, std::function<void()> done) override {
    waiting_.push_back({std::move(work), std::move(done)});
  }
  bool run_one() {
    if (waiting_.empty()) return false;
    Piece piece = std::move(waiting_.front());
    waiting_.pop_front();
    piece.work();
    piece.done();
    return true;
  }
  void run() {
    while (run_one()) continue;
  }
  std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Piece {
    std::function<void()> work, done;
  };
  std::deque<Piece> waiting_;
};

class MemoryMachineFile : public MachineFilePort {
 public:
  std::string text = "name = \"old\"\n";
  Result<Text, Sentence> read() override { return Text{text, "machine.toml", true}; }
  Result<void, Sentence> write(std::string_view fresh) override {
    text = fresh;
    return {};
  }
};

class TextSource : public joblink::UploadSource {
 public:
  explicit TextSource(std::string text) : text_(std::move(text)) {}
  std::size_t read(std::uint64_t offset, std::span<char> buffer) override {
    if (offset >= text_.size()) return 0;
    const std::size_t n = std::min<std::size_t>(buffer.size(), text_.size() - offset);
    std::memcpy(buffer.data(), text_.data() + offset, n);
    return n;
  }

 private:
  std::string text_;
};

/// A client and its stream to the gateway.
struct LinkedClient {
  explicit LinkedClient(joblink::Client::Options options) : link(std::move(options)) {}
  joblink::Client link;
  std::unique_ptr<ByteSession> session;
  std::vector<joblink::News> news;

  template <typename T>
  std::vector<T> all() const {
    std::vector<T> found;
    for (const auto& n : news)
      if (const T* t = std::get_if<T>(&n)) found.push_back(*t);
    return found;
  }
  bool saw_event(joblink::EventKind kind) const {
    for (const auto& event : all<joblink::Event>())
      if (event.kind() == kind) return true;
    return false;
  }
};

class LinkRig {
 public:
  static constexpr const char* bus = "inproc";  ///< whatever the machine file says
  /// `stored`: names of jobs that are there already.
  explicit LinkRig(JobStore::Options options = {}, const std::vector<std::string>& stored = {},
                   MachineDescription of = default_m1())
      : machine(std::move(of)) {
    options.folder = folder.path() / "jobs";
    std::filesystem::create_directories(options.folder);
    for (const std::string& name : stored) std::ofstream(options.folder / name) << "G1 X1\n";
    options.margin_bytes = 0;
    store = JobStore::open(options, 1000);
    server = std::make_unique<JobLinkServer>(
        *machine.gateway, machine.machine, *store, worker, machine_file, control,
        JobLinkServer::Options{
            .version = "test", .gateway_id = "id", .secret = "secret", .machine_mark = "mark", .bus = bus});
  }
  ~LinkRig() {
    clients.clear();
    worker.run();
  }

  LinkedClient& connect(const std::string& name, double status_hz = 0, SessionInfo info = {},
                        std::string token = {}) {
    clients.push_back(std::make_unique<LinkedClient>(
        joblink::Client::Options{.name = name,
                                 .version = "1",
                                 .token = std::move(token),
                                 .status_hz = status_hz,
                                 .session_seed = static_cast<std::uint32_t>(clients.size() + 100)}));
    plug(*clients.back(), std::move(info));
    return *clients.back();
  }
  void plug(LinkedClient& client, SessionInfo info = {}) {
    client.session = server->open(machine.now, std::move(info));
    client.link.on_connected(machine.now);
    pump();
  }
  /// The cable is pulled: what is on its way is lost.
  void unplug(LinkedClient& client) {
    if (client.session) client.session->on_closed(machine.now, "unplugged");
    client.session.reset();
    client.link.on_disconnected(machine.now, "unplugged");
    collect();
  }

  /// Moves bytes until nothing stirs any more; `budget`: bytes from `limited` to the gateway at most.
  void pump(LinkedClient* limited = nullptr, std::size_t budget = SIZE_MAX) {
    for (bool stirred = true; stirred;) {
      stirred = false;
      for (const auto& client : clients) {
        if (!client->session) continue;
        stirred = to_gateway(*client, client.get() == limited ? &budget : nullptr) || stirred;
        // Its share of a turn, as the hub gives it.
        const bool waits = client->session->next_deadline() <= LocalTime{0};
        if (waits) client->session->on_time(machine.now);
        stirred = to_client(*client) || waits || stirred;
      }
      stirred = worker.run_one() || stirred;
      for (; told < machine.events.size(); stirred = true)
        server->on_event(machine.now, machine.events[told++]);
      server->on_time(machine.now);
    }
    collect();
  }
  /// Lets time pass, with the machine moving and all clients served every few ms.
  bool run_until(const std::function<bool()>& done, BusTime limit) {
    const BusTime until = machine.now + limit;
    while (!done()) {
      if (machine.now >= until) return false;
      machine.run_for(std::chrono::milliseconds{20});
      for (const auto& client : clients) {
        client->link.on_time(machine.now);
        if (client->session) client->session->on_time(machine.now);
      }
      pump();
    }
    return true;
  }
  void run_for(BusTime duration) {
    run_until([] { return false; }, duration);
  }

  joblink::Reply ask(LinkedClient& client, joblink::ClientMessage request) {
    const joblink::RequestId id = client.link.send(std::move(request));
    pump();
    for (const auto& answer : client.all<joblink::Answer>())
      if (answer.request == id) return answer.reply;
    joblink::Reply none;
    none.mutable_error()->set_rule("no answer came");
    return none;
  }
  joblink::UploadId upload(LinkedClient& client, const std::string& name, const std::string& text) {
    return client.link.upload({.name = name, .size_bytes = text.size(), .hash = joblink::job_hash_of(text)},
                              std::make_unique<TextSource>(text));
  }

  TemporaryFolder folder;
  MachineRig machine;
  LaterWorker worker;
  MemoryMachineFile machine_file;
  Control control;
  std::unique_ptr<JobStore> store;
  std::unique_ptr<JobLinkServer> server;
  std::vector<std::unique_ptr<LinkedClient>> clients;
  std::size_t told = 0;

 private:
  bool to_gateway(LinkedClient& client, std::size_t* budget) {
    if (!client.session->wants_bytes()) return false;
    const auto bytes = client.link.next_bytes();
    const std::size_t n =
        std::min({bytes.size(), std::size_t{30'000}, budget != nullptr ? *budget : SIZE_MAX});
    if (n == 0) return false;
    const std::vector<std::uint8_t> copy(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    client.link.on_bytes_sent(n);
    if (budget != nullptr) *budget -= n;
    client.session->on_bytes(machine.now, copy);
    return true;
  }
  bool to_client(LinkedClient& client) {
    const auto bytes = client.session->next_bytes();
    if (bytes.empty()) return false;
    const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
    client.session->on_bytes_sent(copy.size());
    client.link.on_bytes(machine.now, copy);
    return true;
  }
  void collect() {
    for (const auto& client : clients)
      while (auto news = client->link.next_news()) client->news.push_back(std::move(*news));
  }
};

inline joblink::ClientMessage take_control(bool force = false) {
  joblink::ClientMessage message;
  message.mutable_take_control()->set_force(force);
  return message;
}

/// plain(&joblink::ClientMessage::mutable_hold)
template <typename Body>
joblink::ClientMessage plain(Body* (joblink::ClientMessage::*body)()) {
  joblink::ClientMessage message;
  (message.*body)();
  return message;
}

}  // namespace kinebus
