#pragma once
// A machine whose gateway keeps a journal and may be replaced by another one that reads it.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/jobs/journal/journal_codec.hpp"
#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/tests/machine_rig.hpp"

namespace kinebus {

using namespace std::chrono_literals;

/// A rounded zigzag with extrusion: corners, an arc, a retraction, a wait.
inline const std::string kResumeJob =
    "G21 G90 M83\n"
    "G1 Z10 F6000\n"
    "G1 X20 E1 F2400\n"
    "G1 Y15 E0.7\n"
    "G2 X-5 Y15 I-12.5 J0 E2\n"
    "G1 E-0.8 F2000\n"
    "G4 P0.2\n"
    "G1 E0.8\n"
    "G1 X-20 Y-10 E1.5 F3000\n"
    "G1 X30 Y-12 E2\n"
    "M106 S128\n"
    "G1 X0 Y0 Z12 E1\n";

/// Watches the motors: the tool's distance from the programmed path, and the filament.
class ResumeRig : public MachineRig {
 public:
  explicit ResumeRig(MachineDescription description = default_m1(), std::uint64_t seed = 1)
      : MachineRig(std::move(description), {}, seed) {
    machine.thermal.min_extrude_c = 0;
    gateway = std::make_unique<Gateway>(machine, Gateway::Options{.journal = true});
    kinematics_ = std::move(*make_kinematics(machine));
  }

  bool begin(double at_s) {
    if (!make_ready()) return false;
    gateway->carry_out(command::SetTemperature{kFirstHotend, 0});
    if (!gateway->carry_out(command::Run{std::make_unique<StringSource>(job_text), "part"})) return false;
    if (!reach(MachineState::kRunning, 5s)) return false;
    if (!run_until([&] { return gateway->status().line >= 2; }, 30s)) return false;
    run_for(BusTime{static_cast<std::int64_t>(at_s * 1e9)});
    return gateway->state() == MachineState::kRunning;
  }
  /// Lets the job go on to its end, measuring.
  bool finish(BusTime limit = 120s) {
    return run_until(
        [&] {
          watch();
          return gateway->state() == MachineState::kReady && !gateway->status().interrupted;
        },
        limit);
  }
  /// A new gateway in place of the old one, with what its journal has in the file.
  void replace_gateway(std::size_t cut = 0) {
    store();
    file_.resize(file_.size() - std::min(cut, file_.size()));
    const auto decoded = journal::decode(file_);
    epoch_ = static_cast<std::uint8_t>(epoch_ + 1);
    gateway = std::make_unique<Gateway>(machine, Gateway::Options{.epoch = epoch_, .journal = true});
    file_.clear();
    number_ = 0;
    for (const journal::Record& record : decoded.state.records()) journal::encode(record, number_++, file_);
    job_noted = decoded.state.job.has_value();
    const auto recovered = gateway->recover(decoded.state, std::make_unique<StringSource>(job_text));
    ASSERT_TRUE(recovered) << recovered.error().words;
    run_for(10ms);
  }
  /// As the daemon does.
  void store() {
    while (auto record = gateway->next_journal_record()) {
      journal::encode(*record, number_++, file_);
      ++stored_;
    }
    gateway->on_journal_stored(stored_);
  }
  void run(BusTime duration) {
    const BusTime until = now + duration;
    run_until(
        [&] {
          watch();
          return now >= until;
        },
        duration);
  }
  void watch() {
    store();
    const JointVector j = joints();
    Pose pose = kinematics_->bed_reference();
    if (!kinematics_->forward(Frame::kMachine, j, pose)) return;
    filament_mm = pose[kE];
    lowest_mm = std::min(lowest_mm, pose[kZ]);
    if (last_) {
      for (std::size_t i = 0; i < machine.joints.size(); ++i) {
        const double speed = std::abs(j[i] - (*last_)[i]);
        worst_step = std::max(worst_step, speed);
      }
    }
    if (track_) track_->push_back(pose);
  }

  Pose pose() {
    Pose pose = kinematics_->bed_reference();
    EXPECT_TRUE(kinematics_->forward(Frame::kMachine, joints(), pose));
    return pose;
  }

  std::string job_text = kResumeJob;
  double filament_mm = 0, worst_step = 0, lowest_mm = 1e9;
  bool job_noted = false;
  std::vector<Pose>* track_ = nullptr;

 private:
  std::unique_ptr<Kinematics> kinematics_;
  std::vector<std::uint8_t> file_;
  std::uint32_t number_ = 0;
  std::uint64_t stored_ = 0;
  std::uint8_t epoch_ = 1;
  std::optional<JointVector> last_;
};

}  // namespace kinebus
