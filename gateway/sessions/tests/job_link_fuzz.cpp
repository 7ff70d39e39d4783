// Any bytes into the gateway's end of the job link, raw and as messages within right frames. What must wait
// for the disk is done by a worker that drops it: the store is another target's business.

#include <cstdint>
#include <filesystem>
#include <span>

#include "gateway/description/machine_description.hpp"
#include "gateway/sessions/job_link_server.hpp"
#include "protocol/joblink/frame_codec.hpp"

namespace {

class DroppingWorker : public kinebus::Worker {
 public:
  void post(std::function<void()>, std::function<void()>) override {}
};
class NoMachineFile : public kinebus::MachineFilePort {
 public:
  kinebus::Result<Text, kinebus::Sentence> read() override { return Text{}; }
  kinebus::Result<void, kinebus::Sentence> write(std::string_view) override { return {}; }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus;
  static const MachineDescription machine = default_m1();
  static const auto store = JobStore::open({.folder = "/dev/null/none"}, 0);
  Gateway gateway(machine);
  DroppingWorker worker;
  NoMachineFile file;
  Control control;
  JobLinkServer server(gateway, machine, *store, worker, file, control, {});
  LocalTime now{0};
  const auto session = server.open(now, {});
  joblink::ClientMessage hello;
  hello.mutable_hello()->set_version_major(1);
  std::string bytes;
  joblink::append_frame(bytes, 9, 0, hello.SerializeAsString());
  std::uint32_t sequence = 1;
  std::span<const std::uint8_t> rest(data, size);
  while (!rest.empty()) {
    // A piece: how it is given, its length, its bytes.
    const std::uint8_t kind = rest.front();
    const std::size_t length = rest.size() > 1 ? std::min<std::size_t>(rest[1], rest.size() - 2) : 0;
    const std::span<const std::uint8_t> piece =
        rest.size() > 2 ? rest.subspan(2, length) : std::span<const std::uint8_t>();
    const std::string_view text(reinterpret_cast<const char*>(piece.data()), piece.size());
    if (kind % 4 != 0)
      joblink::append_frame(bytes, 9, sequence++, text);
    else
      bytes += text;
    now += std::chrono::milliseconds{kind};
    session->on_bytes(now, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    bytes.clear();
    gateway.on_time(now);
    session->on_time(now);
    server.on_time(now);
    session->on_bytes_sent(session->next_bytes().size());
    rest = rest.subspan(std::min(rest.size(), 2 + piece.size()));
  }
  return 0;
}
