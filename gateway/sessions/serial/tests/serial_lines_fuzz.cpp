// Any bytes on the serial port, at any times: nothing may crash, hang or grow without bound, and every line
// gets its "ok" or is asked for again. The same lines go into the checker of live lines with a machine that
// may move.

#include <cstdlib>
#include <string_view>

#include "gateway/description/machine_description.hpp"
#include "gateway/jobs/live_lines.hpp"
#include "gateway/sessions/serial/marlin_session.hpp"

namespace kinebus {
namespace {

class NoFiles : public SerialFiles {
 public:
  void list(const Asked& answer) override {
    answer->entries = {{"part.gcode", 12}};
    answer->done = true;
  }
  void size(const Asked& answer, std::string_view name) override {
    if (name == "part.gcode")
      answer->entries = {{"part.gcode", 12}};
    else
      answer->refused = "no such job";
    answer->done = true;
  }
  void run(const Asked& answer, std::string_view) override {
    answer->refused = "not ready";
    answer->done = true;
  }
  void remove(const Asked& answer, std::string_view) override { answer->done = true; }
  void store(const Asked& answer, std::string_view, std::string) override { answer->done = true; }
};

void check(bool holds) {
  if (!holds) std::abort();
}

}  // namespace
}  // namespace kinebus

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus;
  static const MachineDescription machine = default_m1();
  static const std::unique_ptr<Kinematics> kinematics = std::move(*make_kinematics(machine));

  // Building it takes longer than everything else: it is kept as long as nothing was begun.
  static std::unique_ptr<Gateway> kept;
  if (!kept || kept->state() != MachineState::kOff) kept = std::make_unique<Gateway>(machine);
  Gateway& gateway = *kept;
  gateway.forget_line_modes();
  NoFiles files;
  MarlinSession session(gateway, files);
  static LocalTime now{0};
  now += std::chrono::seconds{1};
  // 0x01 lets time pass; all else is what came.
  for (std::size_t at = 0; at < size;) {
    std::size_t end = at;
    while (end < size && data[end] != 1) ++end;
    if (session.wants_bytes()) session.on_bytes(now, {data + at, end - at});
    now += std::chrono::milliseconds{500};
    gateway.on_time(now);
    session.on_time(now);
    check(session.next_bytes().size() < (2U << 20U));
    if (end % 3 == 0) session.on_bytes_sent(session.next_bytes().size());
    at = end + 1;
  }
  session.on_closed(now, "the end");

  LiveLines lines(machine, *kinematics);
  gcode::CommandBuffer out;
  lines.begin(kinematics->bed_reference(), {}, out);
  std::string_view text(reinterpret_cast<const char*>(data), size);
  std::uint32_t number = 0;
  while (!text.empty() && number < 200) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out.clear();
    if (!lines.take(text.substr(0, end), ++number, out)) check(out.empty());
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return 0;
}
