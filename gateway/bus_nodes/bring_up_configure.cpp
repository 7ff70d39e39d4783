// Bring-up, the nodes' parameters: written where the fingerprint differs, and stored.

#include <cstdio>
#include <utility>

#include "gateway/bus_nodes/bring_up.hpp"
#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr BusTime kRestartTimeout = 5s;
/// Erasing a sector of flash memory takes up to 2 s on the board; nothing else is answered meanwhile.
constexpr BusTime kStoreTimeout = 8s;
constexpr BusTime kFingerprintAgain = 200ms;

}  // namespace

/// A heat node is asked for each of its settings: it may be hot, and what it has already it need not be told.
/// Otherwise it is taken out of operation and cools: it takes settings in no other state.
void BringUp::compare(NodeLink& link, Node& node) {
  const std::vector<ParameterWrite>& wanted = node.configuration.writes;
  if (!node.requested) {
    node.requested = true;
    node.compared = 0;
    for (const ParameterWrite& write : wanted) link.sdo().read(write.address);
    return;
  }
  while (const auto answer = result(link, AlarmCode::kConfiguration)) {
    const ParameterWrite& write = wanted[node.compared++];
    const std::uint64_t mask = (std::uint64_t{1} << (8 * write.size)) - 1;
    node.differs =
        node.differs ||
        ((static_cast<std::uint64_t>(answer->value) ^ static_cast<std::uint64_t>(write.value)) & mask) != 0;
  }
  if (failed_ || node.compared < wanted.size()) return;
  node.requested = false;
  if (!node.differs) return parameters_are_right(node);
  out_.push_back(nmt_frame(NmtCommand::kEnterPreOperational, link.id()));
  for (const ParameterWrite& write : node.configuration.before) link.sdo().write(write);
  node.config = Config::kWriting;
}

/// Fingerprint equal: done. Else all parameters are written; when that does not do, after a return to the
/// defaults.
void BringUp::configure(BusTime now, NodeLink& link, Node& node) {
  if (node.config == Config::kRestarting) {
    if (link.take_boot_up()) {
      node.config = Config::kWriting;
      node.requested = false;
    } else if (now - node.asked > kRestartTimeout) {
      fail(AlarmCode::kNodeMissing, link.id(),
           say("node %1 did not come back after the return to its default parameters", link.id()));
    }
    return;
  }
  if (node.config == Config::kSettling) return settle(now, link, node);
  if (node.config == Config::kCheck && !node.configuration.before.empty()) return compare(link, node);
  // Without a fingerprint the few parameters are written every time.
  if (node.config == Config::kCheck && !node.configuration.fingerprint) node.config = Config::kWriting;
  if (!node.requested) {
    node.requested = true;
    switch (node.config) {
      case Config::kCheck:
        // Of a homing that did not come to its end: no reason to give the node all its parameters again.
        if (link.reports()) link.set_report_period({});
        [[fallthrough]];
      case Config::kVerify:
        link.sdo().read(object::kFingerprint);
        break;
      case Config::kWriting:
        for (const ParameterWrite& write : node.configuration.writes) link.sdo().write(write);
        break;
      case Config::kStoring:
        link.sdo().write({object::kStoreParameters, 4, kSaveSignature});
        break;
      case Config::kSettings:
        for (const ParameterWrite& write : node.configuration.settings) link.sdo().write(write);
        for (const ObjectAddress& sensor : node.configuration.load_sensors) link.sdo().read(sensor);
        break;
      case Config::kRestoring:
        // A node with power for its motors writes no flash; the reset that comes takes it anyway.
        for (std::size_t axis = 0; axis < kAxesPerNode; ++axis)
          link.sdo().write({on_axis(object::kControlword, axis), 2, 0});
        link.sdo().write({object::kRestoreParameters, 4, kLoadSignature});
        break;
      case Config::kSettling:
      case Config::kRestarting:
      case Config::kDone:
        break;
    }
    return;
  }
  if (node.config == Config::kStoring) {
    // A node without memory for its parameters works as well; it is written to at every bring-up.
    if (!link.sdo().next_result()) return;
    node.config = Config::kSettling;
    node.requested = false;
    node.stored = node.asked = now;
    return;
  }
  while (const auto answer = result(link, AlarmCode::kConfiguration))
    if (node.config == Config::kSettings && answer->read)
      check_load_sensor(link, *answer);
    else if (answer->read)
      return check_fingerprint(link, node, static_cast<std::uint32_t>(answer->value));
  if (failed_ || !link.sdo().idle()) return;
  node.requested = false;
  if (node.config == Config::kWriting && !node.configuration.fingerprint) {
    parameters_are_right(node);
  } else if (node.config == Config::kSettings) {
    node.config = Config::kDone;
    node.done = true;
  } else if (node.config == Config::kWriting) {
    node.config = Config::kVerify;
  } else if (node.config == Config::kRestoring) {
    static_cast<void>(link.take_boot_up());
    out_.push_back(nmt_frame(NmtCommand::kResetNode, link.id()));
    node.asked = now;
    node.config = Config::kRestarting;
  }
}

void BringUp::parameters_are_right(Node& node) {
  node.done = node.configuration.settings.empty() && node.configuration.load_sensors.empty();
  node.config = node.done ? Config::kDone : Config::kSettings;
  node.requested = false;
}

void BringUp::check_load_sensor(const NodeLink& link, const SdoResult& answer) {
  if (auto words = load_sensor_missing(machine_, link.id(), answer.address, answer.value))
    fail(AlarmCode::kConfiguration, link.id(), std::move(*words));
}

/// Until the node answers again after storing.
void BringUp::settle(BusTime now, NodeLink& link, Node& node) {
  if (!node.requested) {
    if (now - node.asked < kFingerprintAgain && now != node.stored) return;
    node.requested = true;
    link.sdo().read(object::kFingerprint);
    return;
  }
  const auto answer = link.sdo().next_result();
  if (!answer) return;
  node.requested = false;
  node.asked = now;
  if (answer->abort == AbortCode::kNone) {
    parameters_are_right(node);
  } else if (now - node.stored > kStoreTimeout) {
    fail(AlarmCode::kConfiguration, link.id(), to_string(link.id(), *answer));
  }
}

void BringUp::check_fingerprint(NodeLink& link, Node& node, std::uint32_t fingerprint) {
  node.requested = false;
  link.reports_ended();
  const bool equal = fingerprint == node.configuration.fingerprint;
  if (node.config == Config::kCheck) {
    node.config = Config::kWriting;
    if (equal) parameters_are_right(node);
  } else if (equal) {
    node.config = Config::kStoring;
  } else if (!std::exchange(node.rewritten, true)) {
    node.config = Config::kRestoring;
  } else {
    fail(AlarmCode::kConfiguration, link.id(),
         say("node %1: its parameters have the fingerprint %2, the machine file's have %3, after all were "
             "written",
             link.id(), printed("%08Xh", static_cast<unsigned>(fingerprint)),
             printed("%08Xh", static_cast<unsigned>(*node.configuration.fingerprint))));
  }
}

}  // namespace kinebus
