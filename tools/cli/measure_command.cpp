#include "tools/cli/measure_command.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "tools/cli/client.hpp"
#include "tools/cli/encoder_rows.hpp"

namespace kinebus {
namespace {

// Scales are read when the machine has come to rest, one of a node after the other.
constexpr int kLooks = 30;
constexpr auto kLook = std::chrono::milliseconds{100};

void measure(const Reach& reach, const std::string& file) {
  Client client(reach);
  joblink::ClientMessage ask_machine;
  ask_machine.mutable_get_machine();
  const joblink::Reply machine = client.ask(std::move(ask_machine));
  EncoderRows rows;
  for (int look = 0; look < kLooks; ++look) {
    if (look > 0) std::this_thread::sleep_for(kLook);
    const joblink::Status status = client.status();
    if (!status.positions_known()) throw std::runtime_error("measure: positions are unknown: home first");
    if (!status.at_rest())
      throw std::runtime_error("measure: the machine moves; a reading wants it at rest (" + status.doing() +
                               ")");
    rows = encoder_rows(status, machine.machine());
    if (rows.silent.empty()) break;
  }
  if (!rows.silent.empty())
    throw std::runtime_error("measure: the scale of " + rows.silent.front() +
                             " is not heard: bring the machine up and home it again");
  if (rows.csv.empty())
    throw std::runtime_error(
        "measure: no linear joint has a scale ([joint.NAME.scale]) or an encoder that is heard "
        "([joint.NAME.motor] encoder)");
  const std::string sources = source_words(rows);
  const bool begun = std::filesystem::exists(file) && std::filesystem::file_size(file) != 0;
  std::ofstream out(file, std::ios::app);
  out << (begun ? "" : sources + kEncoderHeader) << rows.csv << std::flush;
  if (!out) throw std::runtime_error("measure: cannot write " + file);
  fmt::print("{}{}", sources, rows.csv);
}

}  // namespace

void add_measure_command(CLI::App& app, const std::shared_ptr<MachineOptions>& options) {
  auto* command = app.add_subcommand("measure",
                                     "Append where each joint is told to be and where its linear scale has "
                                     "it (without one: its motor's encoder):\n"
                                     "for kinebus-calibrate rails");
  auto file = std::make_shared<std::string>();
  command->add_option("file", *file, "CSV file to append to")->required();
  command->callback([=] { measure(options->reach, *file); });
}

}  // namespace kinebus
