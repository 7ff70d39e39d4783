// What `kinebus measure` writes is what the rails' calibration reads.
#include "tools/cli/encoder_rows.hpp"
#include "gateway/description/machines_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "gateway/description/machine_file.hpp"
#include "tools/calibrate/readings.hpp"

namespace kinebus {
namespace {

TEST(EncoderRows, AScaleErrorThatTheEncodersSeeIsFoundByTheRailsFit) {
  const auto machine = load_machine(machines_folder() / "m5.toml");
  ASSERT_TRUE(machine) << to_string(machine.error());
  joblink::MachineInfo info;
  joblink::Status status;
  for (const JointDescription& joint : machine->joints) {
    joblink::Joint& j = *info.add_joints();
    j.set_name(joint.name);
    j.set_rotary(joint.rotary);
    j.set_node(static_cast<std::uint32_t>(info.joints_size() - 1) / 2 + 1);
    j.set_axis(static_cast<std::uint32_t>(info.joints_size() - 1) % 2);
    status.add_joints(0);
    if (j.axis() == 0) status.add_nodes()->set_id(j.node());
    status.mutable_nodes()->rbegin()->add_axes();
  }
  constexpr double kScale = 1.0004;
  std::string csv = kEncoderHeader;
  for (int pass = 0; pass < 2; ++pass)
    for (int step = 0; step <= 20; ++step) {
      for (int i = 0; i < 2; ++i) {
        const double at = 100 + 10.0 * (pass == 0 ? step : 20 - step);
        status.set_joints(i, at);
        status.mutable_nodes(0)->mutable_axes(i)->set_off_course(at - kScale * at);
      }
      csv += encoder_rows(status, info).csv;
    }
  const auto read = Csv::parse(csv);
  ASSERT_TRUE(read) << csv;
  const auto samples = rail_samples(*read, *machine);
  ASSERT_TRUE(samples);
  ASSERT_EQ(samples->size(), 2u) << "joints without encoder give no rows";
  for (const auto& [name, rows] : *samples) {
    ASSERT_EQ(rows.size(), 42u) << name;
    EXPECT_NEAR(fit_rail(rows, {}).calibration.scale, kScale - 1, 2e-6) << name;
  }
}

TEST(EncoderRows, WithoutAnEncoderThereIsNothingToWrite) {
  joblink::MachineInfo info;
  info.add_joints()->set_node(1);
  joblink::Status status;
  status.add_joints(5);
  EXPECT_EQ(encoder_rows(status, info).csv, "") << "its node is not there";
  status.add_nodes()->set_id(1);
  status.mutable_nodes(0)->add_axes();
  EXPECT_EQ(encoder_rows(status, info).csv, "") << "its node tells nothing";
}

}  // namespace
}  // namespace kinebus
