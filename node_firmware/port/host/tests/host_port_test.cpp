#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "node_firmware/port/host/axis_plant.hpp"
#include "node_firmware/port/host/image_file.hpp"

namespace kinebus {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << 32;

TEST(ImageFile, IsReplacedAsAWholeAndReadBack) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("image_file_test." + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  const ImageFile file(folder / "node.img");
  EXPECT_TRUE(file.read().empty());
  const std::vector<std::uint8_t> first{1, 2, 3, 0, 255}, second{9};
  EXPECT_TRUE(file.replace(first));
  EXPECT_EQ(file.read(), first);
  EXPECT_TRUE(file.replace(second));
  EXPECT_EQ(file.read(), second);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::filesystem::remove_all(folder);
  EXPECT_FALSE(file.replace(first));
}

TEST(ImageFile, WithoutAPathKeepsNothingAndIsContent) {
  const ImageFile file("");
  EXPECT_TRUE(file.read().empty());
  EXPECT_TRUE(file.replace(std::vector<std::uint8_t>{1}));
}

TEST(AxisPlant, TellsTheLevelAtPowerUpAndEdgesWhenTheyWere) {
  AxisPlant plant({.start_counts = 1000, .switch_input = 3, .switch_counts = 1500});
  const auto at_power_up = plant.on_position(LocalTime{0}, 0);
  ASSERT_TRUE(at_power_up);
  EXPECT_EQ(at_power_up->input, 2);
  EXPECT_FALSE(at_power_up->level);
  EXPECT_FALSE(plant.on_position(LocalTime{1'000'000}, 400 * kOne));
  // 400 to 600 in 1 ms: the edge at 500 in the middle.
  const auto edge = plant.on_position(LocalTime{2'000'000}, 600 * kOne);
  ASSERT_TRUE(edge);
  EXPECT_TRUE(edge->level);
  EXPECT_EQ(edge->at, LocalTime{1'500'000});
  EXPECT_EQ(plant.carriage_counts(), 1600);
}

}  // namespace
}  // namespace kinebus
