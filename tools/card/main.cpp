// kinebus-card: one node on a bench, its motors, currents and switches.

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>

#include "protocol/host/guarded_main.hpp"
#include "protocol/host/patient_can.hpp"
#include "protocol/host/socketcan.hpp"
#include "protocol/host/usage.hpp"
#include "tools/card/card.hpp"
#include "tools/card/card_session.hpp"
#include "tools/card/line_input.hpp"

namespace {

using namespace kinebus;
using namespace std::chrono_literals;

volatile std::sig_atomic_t interrupted = 0;

struct Arguments {
  std::string interface = "can0";
  int node = 1;
  std::string axis = "A";
  std::optional<int> run_ma, hold_ma;
  double turns = 0, turns_per_s = 1;
  std::optional<std::int64_t> counts;
  double every_s = 0;
  bool store = false;
  int index() const { return axis == "B" ? 1 : 0; }
};

// Of the usual motor: 200 full steps of 256 counts.
constexpr double kCountsPerTurn = 200 * 256;

void print(const Card::State& s, int node) {
  fmt::print("node {}: {}, serial number {}\n", node, s.name, s.serial);
  for (std::size_t i = 0; i < s.axes.size(); ++i) {
    const Card::Axis& a = s.axes[i];
    fmt::print("motor {}  {}{}  position {} counts ({})\n", "AB"[i], words_of(a.state),
               a.error_code == 0 ? "" : fmt::format(", error {:04X}h", a.error_code), a.position_counts,
               a.position_known ? "known" : "since power-up");
    fmt::print(
        "         current {:.2f} A measured, run {:.2f} A, hold {:.2f} A  stage {:.1f} C  supply {:.1f} V\n",
        a.measured_ma * 1e-3, a.run_ma * 1e-3, a.hold_ma * 1e-3, a.stage_celsius, a.supply_volts);
  }
  for (std::size_t i = 0; i < s.inputs.size(); ++i) {
    const Card::Input& input = s.inputs[i];
    fmt::print("switch {}  {}{}{}\n", i + 1, input.active ? "active" : "-",
               input.active_low ? "  active low" : "",
               input.function == SwitchFunction::kNone ? "" : fmt::format("  {}", words_of(input.function)));
  }
  for (const std::uint16_t code : s.errors) fmt::print("has told error {:04X}h\n", code);
}

void show(Card& card, const Arguments& arguments) {
  const auto period = std::chrono::duration_cast<LocalTime>(std::chrono::duration<double>(arguments.every_s));
  for (;;) {
    print(card.state(), arguments.node);
    const LocalTime next = monotonic_now() + period;
    while (interrupted == 0 && monotonic_now() < next) ::poll(nullptr, 0, 50);
    if (arguments.every_s <= 0 || interrupted != 0) return;
  }
}

void jog(Card& card, const Arguments& arguments) {
  const auto counts = arguments.counts.value_or(std::llround(arguments.turns * kCountsPerTurn));
  const std::int32_t at = card.jog(arguments.index(), counts, arguments.turns_per_s * kCountsPerTurn,
                                   [] { return interrupted != 0; });
  fmt::print("motor {} stands at {} counts{}, and holds: kinebus-card off {} lets it go\n", arguments.axis,
             at, interrupted != 0 ? " (interrupted)" : "", arguments.axis);
}

void tune(Card& card, const Arguments& arguments) {
  const Card::Tuned tuned = card.tune(arguments.index());
  fmt::print("motor {}: {:.3f} Ohm, {:.3f} mH, {}\n", arguments.axis, tuned.resistance_mohm * 1e-3,
             tuned.inductance_uh * 1e-3,
             tuned.encoder_offset < 0 ? std::string("no encoder")
                                      : fmt::format("encoder offset {} counts", tuned.encoder_offset));
}

void serve(Card& card) {
  LineInput input(STDIN_FILENO);
  CardSession(card, {.next = [&](LocalTime until) { return input.next(until); },
                     .ended = [&] { return interrupted != 0 || input.ended(); },
                     .tell =
                         [](const std::string& line) {
                           fmt::print("{}\n", line);
                           std::fflush(stdout);
                         },
                     .now = monotonic_now})
      .run();
}

int run(int argc, char** argv) {
  CLI::App app(
      "kinebus-card: one node on a bench, without machine file and gateway.\n"
      "What is set counts at once; --store keeps it through power-off. A gateway sets its machine file's "
      "values.");
  Arguments arguments;
  app.add_option("-i,--interface", arguments.interface, "SocketCAN interface")->capture_default_str();
  app.add_option("-n,--node", arguments.node, "Node id (kinebus-node-id list)")
      ->check(CLI::Range(1, 126))
      ->capture_default_str();
  app.require_subcommand(1);
  auto* show_command = app.add_subcommand(
      "show", "Both motors: state, position, currents, temperature, supply; switches; errors that were told");
  show_command->add_option("--every", arguments.every_s, "Again after so many seconds, until Ctrl-C")
      ->check(CLI::Range(0.1, 3600.0));
  auto* current_command = app.add_subcommand("current", "Run and hold current of a motor, peak of a phase");
  current_command->add_option("--run", arguments.run_ma, "mA while it moves")->check(CLI::Range(0, 5000));
  current_command->add_option("--hold", arguments.hold_ma, "mA at rest")->check(CLI::Range(0, 5000));
  auto* on_command = app.add_subcommand("on", "The motor holds where it is");
  auto* off_command = app.add_subcommand("off", "The motor has no current");
  auto* jog_command =
      app.add_subcommand("jog", "Moves a motor from where it is; Ctrl-C stops it by its ramp");
  auto* turns = jog_command->add_option("--turns", arguments.turns, "Of a motor with 200 steps");
  jog_command->add_option("--counts", arguments.counts, "1/256 full steps")->excludes(turns);
  jog_command->add_option("--speed", arguments.turns_per_s, "Turns/s")
      ->check(CLI::Range(0.001, 50.0))
      ->capture_default_str();
  auto* tune_command =
      app.add_subcommand("tune", "Lets the node measure the motor: resistance, inductance, encoder offset");
  auto* session_command = app.add_subcommand(
      "session", "For programs: commands by lines on the standard input, news as JSON, a line each");
  for (auto* command : {current_command, on_command, off_command, jog_command, tune_command})
    command->add_option("motor", arguments.axis, "A or B")->required()->check(CLI::IsMember({"A", "B"}));
  for (auto* command : {current_command, tune_command})
    command->add_flag("--store", arguments.store, "Kept through power-off; no motor has power then");
  if (const auto end = kinebus::parse_arguments(app, argc, argv)) return *end;
  if (*current_command && !arguments.run_ma && !arguments.hold_ma)
    return fmt::print(stderr, "current: expected --run, --hold or both\n"), 2;
  if (*jog_command && arguments.turns == 0 && !arguments.counts)
    return fmt::print(stderr, "jog: expected --turns or --counts\n"), 2;

  SocketCan can;
  if (const std::string error = can.open(arguments.interface, false); !error.empty())
    return fmt::print(stderr, "{}\n", error), 1;
  const BusAccess bus{.send = [&](const CanFrame& frame) { send_or_throw(can, frame); },
                      .receive = [&](LocalTime until) { return receive_until(can, until); },
                      .now = monotonic_now};
  if (NodeIds(bus, {}).gateway_speaks())
    return fmt::print(stderr, "a gateway runs on {}: stop it first (systemctl stop kinebusd)\n",
                      arguments.interface),
           1;
  std::signal(SIGINT, [](int) { interrupted = 1; });
  Card card(bus, static_cast<std::uint8_t>(arguments.node));
  if (*show_command) show(card, arguments);
  if (*session_command) serve(card);
  if (*current_command) card.set_currents(arguments.index(), arguments.run_ma, arguments.hold_ma);
  if (*on_command || *off_command) card.power(arguments.index(), bool(*on_command));
  if (*jog_command) jog(card, arguments);
  if (*tune_command) tune(card, arguments);
  if (arguments.store && *tune_command) card.power(arguments.index(), false);
  if (arguments.store) card.store();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-card", [&] { return run(argc, argv); });
}
