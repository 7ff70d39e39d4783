#include "tools/cli/measure_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tools/cli/client.hpp"
#include "tools/cli/encoder_rows.hpp"

namespace kinebus {
namespace {

void measure(const Reach& reach, const std::string& file) {
  Client client(reach);
  joblink::ClientMessage ask_machine;
  ask_machine.mutable_get_machine();
  const joblink::Reply machine = client.ask(std::move(ask_machine));
  const joblink::Status status = client.status();
  if (!status.positions_known()) throw std::runtime_error("measure: positions are unknown: home first");
  if (!status.at_rest())
    throw std::runtime_error("measure: the machine moves; a reading wants it at rest (" + status.doing() +
                             ")");
  const std::string rows = encoder_rows(status, machine.machine());
  if (rows.empty())
    throw std::runtime_error(
        "measure: no linear joint has an encoder that is heard ([joint.NAME.motor] encoder)");
  const bool begun = std::filesystem::exists(file) && std::filesystem::file_size(file) != 0;
  std::ofstream out(file, std::ios::app);
  out << (begun ? "" : kEncoderHeader) << rows << std::flush;
  if (!out) throw std::runtime_error("measure: cannot write " + file);
  fmt::print("{}", rows);
}

}  // namespace

void add_measure_command(CLI::App& app, const std::shared_ptr<MachineOptions>& options) {
  auto* command = app.add_subcommand(
      "measure",
      "Append where each joint is told to be and where its encoder has it: for kinebus-calibrate rails");
  auto file = std::make_shared<std::string>();
  command->add_option("file", *file, "CSV file to append to")->required();
  command->callback([=] { measure(options->reach, *file); });
}

}  // namespace kinebus
