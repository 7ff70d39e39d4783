// kinebus-vnode: one node of the machine as a Linux process on SocketCAN.

#include <CLI/CLI.hpp>
#include <cstdio>

#include "node_firmware/port/host/virtual_heat_node.hpp"
#include "node_firmware/port/host/virtual_node.hpp"
#include "protocol/host/guarded_main.hpp"
#include "protocol/host/realtime.hpp"
#include "protocol/host/usage.hpp"

namespace {

// The default machine: carriages of 1280 counts/mm on nodes 1 and 2, a bit different in height, with their
// switches under them at 40 mm; node 3 turns the table and feeds the filament.
void set_default_plant(kinebus::VirtualNodeProcessOptions& options) {
  constexpr std::int64_t kCountsPerMm = 1280;
  if (options.node.node_id > 2) return;
  for (int axis = 0; axis < 2; ++axis)
    options.plant[static_cast<std::size_t>(axis)] = {
        .start_counts = (110 - 2 * options.node.node_id + axis) * kCountsPerMm,
        .switch_input = axis + 1,
        .switch_counts = 40 * kCountsPerMm,
        .active_above = false};
}

int serve(kinebus::BusProcess& process, int node, const std::string& interface, int priority) {
  std::string error = process.open();
  if (priority > 0)
    if (const std::string missing = kinebus::become_realtime(priority); !missing.empty())
      error += (error.empty() ? "" : "; ") + std::string("cannot have ") + missing;
  if (error.empty()) {
    std::fprintf(stderr, "kinebus-vnode: node %d on %s\n", node, interface.c_str());
    error = process.run();
  }
  if (!error.empty()) std::fprintf(stderr, "kinebus-vnode: %s\n", error.c_str());
  return error.empty() ? 0 : 1;
}

int run(int argc, char** argv) {
  kinebus::VirtualNodeProcessOptions options;
  int node = 1, priority = 0;
  std::array<std::optional<std::int64_t>, 2> start, edge;
  CLI::App app{
      "One Kinebus node on a CAN interface, with simulated motors and switches; SIGUSR1 presses and\n"
      "releases the E-stop button. With --heat: one with a simulated hot end, bed and fans, which lines of\n"
      "its standard input break and mend: sensor 1 open, sensor 1 pt1000, heater 2 stuck, fan 1 stalled, "
      "flow 12,\n"
      "filament jammed, sensor 1 ok.\n"
      "SIGTERM ends it."};
  app.add_option("-i,--interface", options.interface, "SocketCAN interface, such as vcan0")->required();
  app.add_option("-n,--node", node, "Node id; 0: as stored, or given by LSS")->check(CLI::Range(0, 127));
  app.add_option("--serial", options.node.identity.serial, "Serial number (default: 1000 + node id)");
  app.add_option("--store", options.image_path, "File for stored parameters; without it nothing is kept");
  bool heat = false;
  CLI::Option* as_heat = app.add_flag("--heat", heat, "A heat node instead of one with motors");
  app.add_option("--estop-input", options.emergency_input, "Input of the E-stop button")
      ->check(CLI::Range(1, 7))
      ->capture_default_str();
  app.add_option(
      "--trace", options.trace_path,
      "File for the true positions of both motors, every 2 ms; with --heat for the true temperatures of "
      "hot end and bed, every 100 ms");
  app.add_option("--start-a", start[0], "Carriage A at power-up, counts");
  app.add_option("--start-b", start[1], "Carriage B at power-up, counts");
  app.add_option("--switch-a", edge[0], "Edge of switch A (input 1), counts; active below");
  app.add_option("--switch-b", edge[1], "Edge of switch B (input 2), counts; active below");
  double counts_per_mm = 1280;
  std::array<double, 2> pulses{}, error{}, play{};
  app.add_option("--counts-per-mm", counts_per_mm, "Of the motors, for what follows in mm")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string letter(1, "ab"[axis]);
    app.add_option("--scale-" + letter, pulses[axis],
                   "Pulses a mm of the linear scale on carriage " + letter + "; without it there is none")
        ->check(CLI::Range(1.0, 1e5));
    app.add_option("--screw-error-" + letter, error[axis],
                   "Ratio by which carriage " + letter + " goes further than it is told, such as 0.0014")
        ->check(CLI::Range(-0.1, 0.1));
    app.add_option("--play-" + letter, play[axis], "mm of play between motor and carriage " + letter)
        ->check(CLI::Range(0.0, 10.0));
  }
  app.add_option(
         "--priority", priority,
         "SCHED_FIFO priority and locked memory: above the daemon's (80) where both share a processor, "
         "as a real node has its own")
      ->check(CLI::Range(1, 99));
  for (const char* of_motors :
       {"--estop-input", "--start-a", "--start-b", "--switch-a", "--switch-b", "--counts-per-mm", "--scale-a",
        "--scale-b", "--screw-error-a", "--screw-error-b", "--play-a", "--play-b"})
    as_heat->excludes(app.get_option(of_motors));
  if (const auto end = kinebus::parse_arguments(app, argc, argv)) return *end;

  options.node.node_id = static_cast<std::uint8_t>(node);
  if (options.node.identity.serial == 0) options.node.identity.serial = 1000u + static_cast<unsigned>(node);
  if (heat) {
    kinebus::VirtualHeatNodeProcess process(
        {.interface = options.interface,
         .node = {.node_id = options.node.node_id, .serial = options.node.identity.serial},
         .image_path = options.image_path,
         .trace_path = options.trace_path});
    return serve(process, node, options.interface, priority);
  }
  set_default_plant(options);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    options.plant[axis].scale_pulses = pulses[axis] / counts_per_mm;
    options.plant[axis].screw_error = error[axis];
    options.plant[axis].play_counts = play[axis] * counts_per_mm;
    if (start[axis]) options.plant[axis].start_counts = *start[axis];
    if (!edge[axis]) continue;
    options.plant[axis].switch_counts = *edge[axis];
    options.plant[axis].switch_input = static_cast<int>(axis) + 1;
    options.plant[axis].active_above = false;
  }
  kinebus::VirtualNodeProcess process(options);
  return serve(process, node, options.interface, priority);
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-vnode", [&] { return run(argc, argv); });
}
