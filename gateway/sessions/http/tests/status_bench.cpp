// What one status costs the loop: over a websocket, by a request of HTTP, and its parts.

#include <benchmark/benchmark.h>

#include <string>

#include "gateway/sessions/http/kinebus/message_json.hpp"
#include "gateway/sessions/http/tests/socket_rig.hpp"

namespace kinebus::http {
namespace {

constexpr const char* kAsks = R"({"request_id":7,"get_status":{}})";

struct Bench {
  HttpRig rig;
  LocalTime now;
  Bench() {
    rig.link.machine.make_ready();
    rig.pump();
    now = rig.link.machine.now;
  }
  /// What is sent to `wire`, read at once, as a lane does.
  std::size_t serve(Connection& wire, const std::string& bytes) {
    ByteSession& session = *wire.session;
    session.on_bytes(now, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    if (now >= session.next_deadline()) session.on_time(now);
    const std::size_t answered = session.next_bytes().size();
    session.on_bytes_sent(answered);
    return answered;
  }
};

/// `range(0)`: how many are answered between two turns of the loop.
void BM_OverAWebsocket(benchmark::State& state) {
  Bench bench;
  SocketClient client(bench.rig, "/kinebus/v1/socket");
  const std::string asks = said(kAsks);
  std::size_t bytes = 0;
  std::int64_t n = 0;
  for (auto _ : state) {
    if (n++ % state.range(0) == 0) bench.rig.link.server->on_time(bench.now);
    bytes = bench.serve(client.wire, asks);
  }
  state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(BM_OverAWebsocket)->Arg(1)->Arg(20);

void BM_ByARequest(benchmark::State& state) {
  Bench bench;
  Connection& wire = bench.rig.connect();
  const std::string asks = HttpRig::head("GET", "/kinebus/v1/get_status") + "\r\n";
  std::size_t bytes = 0;
  std::int64_t n = 0;
  for (auto _ : state) {
    if (n++ % state.range(0) == 0) bench.rig.link.server->on_time(bench.now);
    bytes = bench.serve(wire, asks);
  }
  state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(BM_ByARequest)->Arg(1)->Arg(20);

void BM_HoldRead(benchmark::State& state) {
  for (auto _ : state) {
    joblink::ClientMessage message;
    benchmark::DoNotOptimize(from_json(kAsks, message).has_value());
  }
}
BENCHMARK(BM_HoldRead);

void BM_MachineStatus(benchmark::State& state) {
  Bench bench;
  for (auto _ : state) benchmark::DoNotOptimize(bench.rig.link.machine.gateway->status());
}
BENCHMARK(BM_MachineStatus);

void BM_Json(benchmark::State& state) {
  Bench bench;
  joblink::ClientMessage message;
  message.mutable_get_status();
  Caller caller(bench.rig.server, bench.now);
  caller.become({.role = Role::kWatch});
  const joblink::Reply reply = caller.ask_now(message);
  for (auto _ : state) benchmark::DoNotOptimize(to_json(reply));
}
BENCHMARK(BM_Json);

void BM_Asked(benchmark::State& state) {
  Bench bench;
  joblink::ClientMessage message;
  message.mutable_get_status();
  Caller caller(bench.rig.server, bench.now);
  caller.become({.role = Role::kWatch});
  std::int64_t n = 0;
  for (auto _ : state) {
    if (n++ % state.range(0) == 0) bench.rig.link.server->on_time(bench.now);
    benchmark::DoNotOptimize(caller.ask_now(message).status().nodes_size());
  }
}
BENCHMARK(BM_Asked)->Arg(1)->Arg(20);

}  // namespace
}  // namespace kinebus::http
