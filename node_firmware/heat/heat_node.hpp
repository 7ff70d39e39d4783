#pragma once
// A heat node, whole, as a state machine without input or output of its own: sensors, heaters and fans as a
// CANopen device (CiA 404) with a node id of its own. A port feeds it and does what it says:
//
//   on_frame / on_sample / on_tacho / set_supply / on_time -> HeatNode -> next_frame / heater_output /
//   fan_output / contactor / storage
//
// Power is the node's decision alone. A master only asks for temperatures, within limits that no SDO exceeds,
// and only as long as it gives signs of life.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/core/parameter_image.hpp"
#include "node_firmware/heat/fan.hpp"
#include "node_firmware/heat/filament_watch.hpp"
#include "node_firmware/heat/flow_profile.hpp"
#include "node_firmware/heat/heater.hpp"
#include "node_firmware/heat/pin_probe.hpp"
#include "node_firmware/heat/vibration_unit.hpp"
#include "protocol/canopen/emcy.hpp"
#include "protocol/canopen/heartbeat.hpp"
#include "protocol/canopen/heat_objects.hpp"
#include "protocol/canopen/lss.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/pdo_engine.hpp"
#include "protocol/canopen/sdo_server.hpp"
#include "protocol/canopen/sync.hpp"
#include "protocol/motion/session_guard.hpp"

namespace kinebus::heat {

struct HeatNodeOptions {
  std::uint8_t node_id = 0;  ///< 1..127; 0: as stored, and without that the node waits for LSS
  std::uint32_t serial = 0;
  /// The node has its id from its board, and LSS is another's business.
  bool id_from_board = false;
  std::uint32_t program_crc = 0;  ///< 1F56h; 0: a program that no boot loader has started for this node alone
  std::uint8_t max31865 = 0xFF;   ///< sensors that may be measured by one, a bit each
};

class HeatNode final : private ObjectOwner {
 public:
  static constexpr bool kHearsSyncStamps = true;  ///< Hearing
  /// `stored_image`: what image_to_store() gave once; damaged, the defaults are in force, by which nothing
  /// heats.
  HeatNode(const HeatNodeOptions& options, LocalTime now, std::span<const std::uint8_t> stored_image = {});
  HeatNode(const HeatNode&) = delete;
  HeatNode& operator=(const HeatNode&) = delete;

  // In. Sensors, heaters and fans are counted from 0.
  void on_frame(LocalTime at, const CanFrame& frame);
  /// Every SensorInput::kSamplePeriod; `ratio`: see Linearisation; `broken`: the converter says so.
  void on_sample(LocalTime at, int sensor, std::uint32_t ratio, bool broken = false);
  void on_tacho(int fan, std::uint32_t pulses);
  /// Every SensorInput::kSamplePeriod: the level of a filament switch, the edges of a wheel since the last
  /// call.
  void on_filament(int sensor, bool level, std::uint32_t edges) {
    filaments_[static_cast<std::size_t>(sensor)].on_sample(level, edges);
  }
  /// Every SensorInput::kSamplePeriod: the level of the pin probe's line.
  void on_probe_line(LocalTime at, bool level) { pin_probe_.on_sample(at, level); }
  /// Its accelerometer, which the port feeds; nullptr: the board has none.
  void set_vibration(VibrationUnit* unit) { vibration_ = unit; }
  /// Another node of the same board has power: flash is not written then.
  void set_neighbours_powered(bool powered) { neighbours_powered_ = powered; }
  /// 0: not measured.
  void set_supply(std::uint16_t mv) { supply_mv_ = mv; }
  /// Needed at next_deadline(); allowed at any time.
  void on_time(LocalTime now);

  // Out.
  std::optional<CanFrame> next_frame();
  LocalTime next_deadline() const;
  /// Parts of kFullPower; to be followed at once after every input.
  std::uint32_t heater_output(int heater) const;
  /// 0..kFullFan.
  std::uint16_t fan_output(int fan) const { return fans_[static_cast<std::size_t>(fan)].output(); }
  /// Width of the servo's pulses, us, one every PinProbe::kPeriod; 0: none.
  std::uint16_t servo_pulse() const { return pin_probe_.pulse(); }
  /// False: the supply of all heaters is to be cut, since one of them heats without being told to.
  bool contactor() const;
  /// As Node's, for a port that filters; 0: off.
  std::array<std::uint16_t, kRpdoCount> rpdo_cob_ids() const;
  std::array<std::uint8_t, 2> watched_nodes() const;

  /// As Node's: asked for by 1010h, 1011h or LSS, whose answer waits for on_image_stored().
  std::span<const std::uint8_t> image_to_store();
  void on_image_stored(bool good);
  bool take_reset_request();
  /// Watchdog: true as long as control is on time.
  bool healthy(LocalTime now) const;
  std::uint8_t node_id() const { return node_id_; }
  NmtState nmt_state() const { return nmt_.state(); }
  std::int32_t temperature(int sensor) const {
    return sensors_[static_cast<std::size_t>(sensor)].temperature();
  }
  /// What the master has told of the extruder, um.
  std::int32_t filament_commanded(int sensor) const {
    return filaments_[static_cast<std::size_t>(sensor)].commanded();
  }
  /// Something heats, or is to: what holds the processor up has to wait.
  bool heats() const { return any_heat(); }
  /// How it is to be measured.
  const SensorSetup& setup_of(int sensor) const { return sensors_[static_cast<std::size_t>(sensor)].setup(); }
  /// 1F51h = 0: the program is to give way to the boot loader when its answer is on the bus. Nothing heats.
  bool program_stop_requested() const { return program_stop_requested_; }
  HeaterFault fault(int heater) const { return heaters_[static_cast<std::size_t>(heater)].fault(); }

 private:
  enum class Storing : std::uint8_t { kNothing, kWanted, kWriting };

  AbortCode read(const ObjectEntry& entry, std::int64_t& value) override;
  AbortCode write(const ObjectEntry& entry, std::int64_t value) override;
  AbortCode read_device(ObjectAddress address, std::int64_t& value) const;
  AbortCode read_sensor(std::uint16_t index, std::size_t n, std::int64_t& value) const;
  AbortCode read_heater(std::uint16_t index, std::size_t n, std::int64_t& value) const;
  AbortCode read_filament(std::uint16_t index, std::size_t n, std::int64_t& value) const;
  AbortCode write_pin_probe(std::uint16_t index, std::int64_t value);
  AbortCode write_communication(const ObjectEntry& entry, std::int64_t value);
  AbortCode write_heater(std::uint16_t index, std::size_t n, std::int64_t value);
  AbortCode write_set_point(std::size_t n, std::int64_t value);
  AbortCode begin_tuning(std::size_t n, std::int64_t value);
  AbortCode reset_fault(std::size_t n);
  AbortCode confirm(std::int64_t serial);
  AbortCode check_setting(const ObjectEntry& entry, std::int64_t value);
  AbortCode inconsistent(const ObjectEntry& entry) const;
  AbortCode command_storage(ObjectAddress address, std::int64_t value);
  AbortCode command_program(std::int64_t value);
  std::uint8_t heater_state(std::size_t n) const;

  std::int64_t value(ObjectSlot first, std::size_t n = 0) const {
    return objects_.value({static_cast<std::uint16_t>(first.value + n)});
  }
  void set_value(ObjectSlot first, std::size_t n, std::int64_t to) {
    objects_.set_value({static_cast<std::uint16_t>(first.value + n)}, to);
  }
  SensorSetup sensor_setup(std::size_t n) const;
  /// The board has what that sensor is to be measured by.
  bool has_path(std::size_t n) const;
  HeaterSettings heater_settings(std::size_t n) const;
  /// 0..; -1: none.
  int sensor_number(std::size_t heater) const;
  /// nullptr: the heater has none that measures.
  const SensorInput* sensor_of(std::size_t heater) const;
  std::int32_t highest_set_point(std::size_t heater) const;  // 0.1 C
  bool any_heat() const;

  void boot();
  void reset_communication();
  void apply_node_id();
  void apply_communication();
  void apply_settings();
  void configure_sensors();
  /// In a session: not what nobody vouches for while anything heats, nor what lets it heat.
  bool obeys(const CanFrame& frame);
  void serve_session();
  void on_nmt(NmtCommand command);
  void on_sync(const SyncReception& sync);
  void on_lss();
  bool is_sign_of_life(const CanFrame& frame) const;
  void serve();
  void tick();
  void step_fans();
  void watch_master();
  void switch_off();
  void apply_targets();
  void take_tuning_result();
  void tell_faults();

  HeatNodeOptions options_;
  LocalTime now_;
  std::uint8_t node_id_ = 0;
  ImageOf<kHeatTable> image_;
  SizedDictionary<kHeatObjectCount> objects_;
  NmtSlave nmt_;
  HeartbeatProducer heartbeat_;
  HeartbeatConsumer watched_;
  EmcyProducer emcy_;
  SdoServer sdo_;
  PdoEngine pdo_;
  LssSlave lss_;
  SessionGuard session_;
  LocalTime sync_seen_{0};
  std::optional<CanFrame> boot_up_;

  std::array<SensorInput, kHeatSensors> sensors_;
  std::array<Heater, kHeaters> heaters_;
  std::array<Fan, kFans> fans_;
  std::array<FilamentWatch, kFilamentSensors> filaments_;
  PinProbe pin_probe_;
  VibrationUnit* vibration_ = nullptr;
  HeatTuning tuning_;
  int tuned_ = -1;  // the heater that tuning_ measures, or has measured
  bool tuning_taken_ = true;

  std::array<std::int16_t, kHeaters> set_points_{};  // 0.1 C, as the master asks
  std::array<bool, kHeaters> on_{};
  std::array<std::int16_t, kHeaters> feed_forward_{};
  FlowProfile flow_;
  bool fans_change_ = false;
  LocalTime master_seen_{0};
  bool master_lost_ = false;
  LocalTime lost_at_{0};
  std::array<std::int64_t, 2> watched_entries_{};

  LocalTime next_tick_{0};
  std::uint16_t supply_mv_ = 0;
  bool confirmed_ = false;  ///< the master has named this node by its serial number (2243h)
  bool communication_changed_ = false, settings_changed_ = false, sensors_changed_ = false;
  /// Where a fault is, a bit a channel.
  struct Places {
    std::uint8_t heaters = 0, sensors = 0, fans = 0;
  };
  std::array<Places, static_cast<std::size_t>(HeaterFault::kLast) + 1> told_{};
  Storing storing_ = Storing::kNothing;
  bool storing_for_lss_ = false;
  bool reset_requested_ = false;
  bool program_stop_requested_ = false;
  bool neighbours_powered_ = false;
};

}  // namespace kinebus::heat
