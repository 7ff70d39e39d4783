#include "tools/heat_study/flow_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "node_firmware/port/host/heat_plant.hpp"
#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/nmt.hpp"

namespace kinebus::heat_study {
namespace {

using namespace std::chrono_literals;
using namespace heat_object;
using heat::HeatPlant;

constexpr std::uint8_t kId = 20;
constexpr double kPower_w = 44;
constexpr double kRoom_c = 25;
constexpr int kStepsASecond = 100, kStepsAWord = 10;

/// The node, its plant, and a master that speaks to it by frames alone.
class Bench {
 public:
  Bench() : node_({.node_id = kId, .serial = 1}, LocalTime{1s}) { run(0.2); }

  void run(double seconds) {
    for (int i = 0; i < std::lround(seconds * kStepsASecond); ++i) step();
  }
  void step() {
    now_ += HeatPlant::kPeriod;
    node_.on_time(now_);
    plant_.step(node_, now_);
    take();
    if (++steps_ % kStepsASecond == 0) static_cast<void>(read({0x1001, 0}));  // it lives
  }
  void write(ObjectAddress address, std::int64_t value, int bytes) {
    CanFrame request = of(address);
    request.data[0] = static_cast<std::uint8_t>(0x23 | (4 - bytes) << 2);
    put_u32_le(std::span(request.data).subspan(4), static_cast<std::uint32_t>(value));
    if (ask(request) == 0x60) return;
    throw std::runtime_error(fmt::format("the node refuses {:04X}h:{} = {}: abort {:08X}h", address.index,
                                         address.subindex, value, answered_));
  }
  std::uint32_t read(ObjectAddress address) {
    CanFrame request = of(address);
    request.data[0] = 0x40;
    if ((ask(request) & 0xE0) == 0x40) return answered_;
    throw std::runtime_error(fmt::format("the node does not tell {:04X}h", address.index));
  }
  void send(const CanFrame& frame) {
    node_.on_frame(now_, frame);
    take();
  }
  double power_w() const { return node_.heater_output(0) * kPower_w / heat::kFullPower; }
  heat::ThermalPlant& hot_end() { return plant_.hot_end(); }

 private:
  static CanFrame of(ObjectAddress address) {
    CanFrame request{.id = cob_id::kSdoRequest + kId, .length = 8};
    put_u16_le(std::span(request.data).subspan(1), address.index);
    request.data[3] = address.subindex;
    return request;
  }
  std::uint8_t ask(const CanFrame& request) {
    replied_ = 0;
    send(request);
    return replied_;
  }
  void take() {
    while (const auto frame = node_.next_frame()) {
      if (frame->id != cob_id::kSdoReply + kId) continue;
      replied_ = frame->data[0];
      answered_ = get_u32_le(std::span(frame->data).subspan(4));
    }
  }

  LocalTime now_{1s};
  heat::HeatNode node_;
  HeatPlant plant_;
  int steps_ = 0;
  std::uint8_t replied_ = 0;
  std::uint32_t answered_ = 0;
};

std::int64_t tenths(double celsius) {
  return std::lround(10 * celsius);
}

void measure(Bench& bench, double celsius) {
  constexpr std::uint32_t kDone = 4, kFailed = 5;
  bench.write(kTune, tenths(celsius), 2);
  for (std::uint32_t state = 0; (state & 0xF) != kDone; state = bench.read(kTuneState)) {
    if ((state & 0xF) == kFailed) throw std::runtime_error("the node could not measure its heater");
    bench.run(1);
  }
}

/// As the gateway tells it: means over the steps ahead, the first from now.
CanFrame flow_ahead(const Scene& scene, double t_s) {
  CanFrame frame{.id = cob_id::rpdo(4, kId), .length = 8};
  const double step_s = kFlowStepMs * 1e-3;
  const double most_w = scene.filament_j_per_mm3_k * scene.flow_mm3_per_s * (scene.target_c - kRoom_c);
  for (std::size_t i = 0; i < std::size_t{kFlowSteps}; ++i) {
    const double from = t_s + static_cast<double>(i) * step_s, to = from + step_s;
    const double flows = std::clamp(std::min(to, scene.flowing_s) - std::max(from, 0.0), 0.0, step_s);
    put_u16_le(std::span(frame.data).subspan(2 * i),
               static_cast<std::uint16_t>(std::lround(100 * most_w * flows / step_s)));
  }
  return frame;
}

}  // namespace

std::string_view words(Control control) {
  switch (control) {
    case Control::kPid:
      return "PID";
    case Control::kModel:
      return "model";
    case Control::kModelAhead:
      return "model, heated ahead";
  }
  return "";
}

Run flow_step(const Scene& scene, Control control) {
  Bench bench;
  bench.write(kLowestPlausible, -50, 2);
  bench.write(kSensorType, 10'100, 2);  // by beta: the plant's thermistor
  bench.write(kNominalPower, std::lround(1000 * kPower_w), 4);
  bench.write({kHeaterSensor.index, 2}, 0, 1);
  bench.write(kConfirmedSerial, bench.read({object::kVendorIdentity.index, 4}), 4);
  bench.run(0.3);
  measure(bench, scene.target_c);
  bench.write(kControlKind, control == Control::kPid ? 0 : 1, 1);
  bench.send(nmt_frame(NmtCommand::kStart, kId));
  bench.write(kSetPoint, tenths(scene.target_c), 2);
  bench.run(400);

  Run run;
  const double end_s = scene.flowing_s + scene.after_s;
  const auto steps = static_cast<int>(std::lround((scene.before_s + end_s) * kStepsASecond));
  for (int i = 0; i < steps; ++i) {
    const double t_s = static_cast<double>(i) / kStepsASecond - scene.before_s;
    bench.hot_end().flow_mm3_per_s = t_s >= 0 && t_s < scene.flowing_s ? scene.flow_mm3_per_s : 0;
    if (i % kStepsAWord == 0) {
      if (control == Control::kModelAhead) bench.send(flow_ahead(scene, t_s));
      run.samples.push_back({t_s, bench.hot_end().block() - scene.target_c, bench.power_w()});
      run.lowest_k = std::min(run.lowest_k, run.samples.back().off_k);
      run.highest_k = std::max(run.highest_k, run.samples.back().off_k);
    }
    bench.step();
  }
  return run;
}

}  // namespace kinebus::heat_study
