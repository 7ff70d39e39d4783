// Arbitrary bytes, in chunks, never crash the reader, and a refused line changes nothing.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gateway/gcode/canonical_text.hpp"
#include "gateway/gcode/programs/job_reader.hpp"

using namespace kinebus;

namespace {
void require(bool condition) {
  if (!condition) std::abort();
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  gcode::CommandBuffer out;

  // Line by line, going on after errors.
  gcode::Options options;
  options.tool_length_mm = {5};
  options.tool_diameter_mm = {3};
  options.spindle = options.spindle_encoder = (data[0] & 4U) != 0;
  options.most_recorded_steps = 20'000;
  options.dialect = static_cast<gcode::Dialect>((data[0] >> 3U) % gcode::dialects().size());
  options.macros = {
      {"start_print", "o1 if [exists[#<bed>]]\nM190 S[#<bed>]\no1 endif\nG28\n"},
      {"wipe", "while iterations < param.S\n  G1 X{iterations}\n  if iterations > 2\n    M99\n"}};
  options.block_delete = (data[0] & 1U) != 0;
  options.default_feed_mm_per_s = (data[0] & 2U) != 0 ? 10 : 0;
  gcode::Interpreter interpreter(options);
  std::size_t start = 0;
  std::uint32_t number = 0;
  while (start <= text.size()) {
    const std::size_t end = text.find('\n', start);
    const std::string_view line = text.substr(start, end - start);
    const gcode::ModalState before = interpreter.state().modal;
    const std::size_t size_before = out.size();
    if (auto result = interpreter.execute(line, ++number, out); !result) {
      require(!result.error().message.empty() && result.error().column >= 1);
      require(out.size() == size_before);
      require(before.position == interpreter.state().modal.position);
      require(before.program == interpreter.state().modal.program);
    }
    for (std::size_t i = size_before; i < out.size(); ++i) (void)canonical::to_text(out[i]);
    for (const double value : interpreter.state().modal.position) require(std::isfinite(value));
    (void)interpreter.modal_codes();
    if (end == std::string_view::npos) break;
    start = end + 1;
    if (out.size() > 10000) out.clear();
  }

  // The same text in chunks, also going on.
  gcode::Interpreter second(options);
  gcode::JobReader reader(second, 1000);
  const std::size_t chunk = 1 + data[0] / 8;
  out.clear();
  for (std::size_t at = 0; at < text.size(); at += chunk) {
    std::string_view part = text.substr(at, chunk);
    while (!part.empty() || reader.busy()) {
      const std::uint32_t refused = reader.refused();
      const bool good = reader.read(part, out).has_value();
      require(reader.taken() <= part.size() && (good || reader.refused() > refused));
      part.remove_prefix(reader.taken());
      if (!good) reader.skip_refused();
      if (out.size() > 100000) out.clear();
    }
  }
  require(reader.bytes() == text.size());
  for (int i = 0; i < 1000; ++i) {
    if (!reader.finish(out)) reader.skip_refused();
    if (!reader.busy()) break;
    if (out.size() > 100000) out.clear();
  }
  return 0;
}
