#pragma once
// How hot the blocks of hot end and bed really were, ten times a second of the system's clock, as a file: for
// tests that look at heat and motion together. 24 bytes a sample: time in ns, then hot end and bed, mC.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "node_firmware/port/host/heat_plant.hpp"

namespace kinebus {

class HeatTrace {
 public:
  static constexpr LocalTime kPeriod = std::chrono::milliseconds{100};

  /// Appends to `path`; nothing is written without one. False: cannot be opened.
  bool open(const std::string& path) {
    if (path.empty()) return true;
    file_.reset(std::fopen(path.c_str(), "ab"));
    // Whole, whenever the process is killed.
    return file_ && std::setvbuf(file_.get(), nullptr, _IONBF, 0) == 0;
  }
  void sample(heat::HeatPlant& plant, LocalTime now) {
    if (!file_ || now < next_) return;
    next_ = now + kPeriod;
    const auto milli = [](double celsius) { return static_cast<std::int64_t>(std::lround(1e3 * celsius)); };
    const std::array<std::int64_t, 3> row{now.count(), milli(plant.hot_end().block()),
                                          milli(plant.bed().block())};
    std::fwrite(row.data(), sizeof row, 1, file_.get());
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  LocalTime next_{0};
};

}  // namespace kinebus
