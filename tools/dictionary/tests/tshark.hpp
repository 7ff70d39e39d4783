#pragma once
// Frames as a capture file, read by tshark with the dissector of the tables as they stand.

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "protocol/bytes.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/can/frame.hpp"
#include "tools/dictionary/wireshark.hpp"

namespace kinebus {

/// One frame as tshark tells it: the fields that were asked for, by name; several values have commas between.
using DissectedFrame = std::map<std::string, std::string>;

class Tshark {
 public:
  Tshark() {
    std::string pattern = (std::filesystem::temp_directory_path() / "kinebus-tshark-XXXXXX").string();
    EXPECT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    // Where a person's own plugins are.
    const auto plugins = folder_ / ".local/lib/wireshark/plugins";
    std::filesystem::create_directories(plugins);
    std::ofstream(plugins / "kinebus.lua") << wireshark_text();
  }
  ~Tshark() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Tshark(const Tshark&) = delete;
  Tshark& operator=(const Tshark&) = delete;

  /// Link type 227, LINKTYPE_CAN_SOCKETCAN: what candump, tcpdump and Wireshark itself record.
  std::string capture(const std::vector<CanFrame>& frames) const {
    std::string file;
    const auto add = [&file](std::uint64_t value, int bytes) {
      for (int i = 0; i < bytes; ++i) file += static_cast<char>(value >> (8 * i));
    };
    for (const auto& [value, bytes] :
         {std::pair{0xA1B2C3D4u, 4}, {2u, 2}, {4u, 2}, {0u, 4}, {0u, 4}, {65535u, 4}, {227u, 4}})
      add(value, bytes);
    std::uint32_t us = 0;
    for (const CanFrame& frame : frames) {
      us += 130;
      add(us / 1'000'000, 4);
      add(us % 1'000'000, 4);
      add(16, 4);
      add(16, 4);
      const std::uint32_t id =
          frame.id | (frame.extended ? 0x8000'0000u : 0u) | (frame.remote ? 0x4000'0000u : 0u);
      for (int i = 3; i >= 0; --i) file += static_cast<char>(id >> (8 * i));
      add(frame.length, 4);
      for (std::size_t i = 0; i < 8; ++i) file += static_cast<char>(i < frame.length ? frame.data[i] : 0);
    }
    return write("capture.pcap", file);
  }
  /// As `candump -l` writes it.
  std::string candump(const std::vector<CanFrame>& frames) const {
    std::string file;
    std::chrono::microseconds time{1'600'000'000'000'000};
    for (const CanFrame& frame : frames) {
      file += std::string(to_candump({time, "can0", frame}).view()) + "\n";
      time += std::chrono::microseconds{130};
    }
    return write("capture.log", file);
  }

  /// `fields` beside number, protocols, Info and notes. The person's own settings are not used.
  std::vector<DissectedFrame> read(const std::string& capture, const std::vector<std::string>& fields = {},
                                   const std::string& options = "-d can.subdissector,kinebus") const {
    std::vector<std::string> names{"frame.number", "frame.protocols", "_ws.col.Info", "_ws.expert.message",
                                   "kinebus.rest"};
    names.insert(names.end(), fields.begin(), fields.end());
    const std::string folder = folder_.string(), told = folder + "/told", errors = folder + "/errors";
    std::string command = "HOME=" + folder + " XDG_CONFIG_HOME=" + folder + "/.config tshark -n -r " +
                          capture + " " + options +
                          " -T fields -E separator=/t -E occurrence=a -E aggregator=,";
    for (const std::string& name : names) command += " -e " + name;
    const int status = std::system((command + " >" + told + " 2>" + errors).c_str());
    EXPECT_EQ(status, 0) << "tshark (Debian package tshark, tools/setup test) failed:\n" << text_of(errors);
    EXPECT_EQ(text_of(errors).find("Lua"), std::string::npos) << text_of(errors);

    std::vector<DissectedFrame> frames;
    std::istringstream lines(text_of(told));
    for (std::string line; std::getline(lines, line);) {
      DissectedFrame& frame = frames.emplace_back();
      std::size_t at = 0;
      for (const std::string& name : names) {
        const std::size_t tab = line.find('\t', at);
        frame[name] = line.substr(at, tab == std::string::npos ? tab : tab - at);
        at = tab == std::string::npos ? line.size() : tab + 1;
      }
      EXPECT_EQ(frame["_ws.expert.message"].find("Lua Error"), std::string::npos) << line;
    }
    return frames;
  }

 private:
  static std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  std::string write(const char* name, const std::string& text) const {
    const auto path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

  std::filesystem::path folder_;
};

}  // namespace kinebus
