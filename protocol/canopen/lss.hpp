#pragma once
// Layer setting services (CiA 305): node ids given over the bus, to nodes known by their 128-bit identity.

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/can/frame.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// Vendor, product code, revision, serial: 1018h:1-4.
using LssIdentity = std::array<std::uint32_t, 4>;

inline constexpr std::uint8_t kUnconfiguredNodeId = 0xFF;

namespace lss {
inline constexpr std::uint8_t kSwitchGlobal = 4, kConfigureNodeId = 17, kConfigureBitTiming = 19,
                              kActivateBitTiming = 21, kStore = 23, kSelectVendor = 64, kSelectProduct = 65,
                              kSelectRevision = 66, kSelectSerial = 67, kSelected = 68, kIdentifyVendor = 70,
                              kIdentifyProduct = 71, kIdentifyRevisionLow = 72, kIdentifyRevisionHigh = 73,
                              kIdentifySerialLow = 74, kIdentifySerialHigh = 75, kIdentifyUnconfigured = 76,
                              kIdentified = 79, kIdentifiedUnconfigured = 80, kFastscan = 81,
                              kInquireVendor = 90, kInquireNodeId = 94;
}  // namespace lss

class LssSlave {
 public:
  /// `node_id`: that in use, or kUnconfiguredNodeId. `consecutive`: so many ids from the one that is given
  /// are this device's; one that leaves no room for them is refused.
  LssSlave(const LssIdentity& identity, std::uint8_t node_id, std::uint8_t consecutive = 1)
      : identity_(identity),
        active_(node_id),
        pending_(node_id),
        highest_(static_cast<std::uint8_t>(128 - consecutive)) {}

  /// True: the frame was an LSS request. Answers by next_frame().
  bool on_frame(const CanFrame& frame);
  std::optional<CanFrame> next_frame();

  bool configuring() const { return configuring_; }
  std::uint8_t active_node_id() const { return active_; }
  /// Takes effect when an unconfigured node is switched back to waiting (see take_node_id), else at the next
  /// reset of communication.
  std::uint8_t pending_node_id() const { return pending_; }
  /// The id with which a so far unconfigured node is to boot now; once.
  std::optional<std::uint8_t> take_node_id();
  /// To be called at reset of communication: the pending id is the active one from now on.
  void activate() { active_ = pending_; }

  /// The master wants the pending id kept through power-off; answer with finish_store().
  bool take_store_request();
  void finish_store(bool good);
  /// Not now: 255, implementation specific, with 1: a drive has power.
  void refuse_store();

 private:
  void reply(std::uint8_t command, std::uint32_t data = 0);
  void on_identify(std::uint8_t command, std::uint32_t value);
  void on_fastscan(const CanFrame& frame);
  void set_configuring(bool configuring);

  LssIdentity identity_;
  std::uint8_t active_, pending_, highest_;
  bool configuring_ = false;
  bool boot_due_ = false, store_due_ = false;
  std::uint8_t selected_ = 0;       // how many parts of "switch state selective" have matched
  std::uint8_t identified_ = 0;     // the same of "identify remote slave"
  std::uint8_t scan_position_ = 0;  // fastscan: part of the identity under scan
  std::optional<CanFrame> reply_;
};

/// One service at a time: begin it, pass frames and time, until it is no longer kBusy.
class LssMaster {
 public:
  enum class Status : std::uint8_t { kIdle, kBusy, kDone, kNotFound, kRefused, kTimeout };
  struct Options {
    LocalTime timeout = std::chrono::milliseconds{100};   ///< for an answer that must come
    LocalTime scan_wait = std::chrono::milliseconds{10};  ///< fastscan: silence this long means "no node"
  };
  LssMaster() = default;
  explicit LssMaster(Options options) : options_(options) {}

  // Each is false while another service is busy.
  bool switch_all(LocalTime now, bool configuration);
  /// kNotFound: no node has that identity.
  bool select(LocalTime now, const LssIdentity& identity);
  /// Of the one node that is in configuration. kRefused: error_code() of the node.
  bool configure_node_id(LocalTime now, std::uint8_t node_id);
  bool store(LocalTime now);
  bool inquire_node_id(LocalTime now);
  /// `part`: 0 vendor .. 3 serial.
  bool inquire_identity(LocalTime now, int part);
  /// Finds one unconfigured node, whose identity() then is known and which is then in configuration. 132
  /// frames at most, scan_wait each: about 1.4 s. kNotFound: there is none.
  bool fastscan(LocalTime now);

  void on_frame(const CanFrame& frame);
  void on_time(LocalTime now);
  std::optional<CanFrame> next_frame();
  LocalTime next_deadline() const { return status_ == Status::kBusy ? due_ : LocalTime::max(); }

  Status status() const { return status_; }
  std::uint32_t value() const { return value_; }             ///< of an inquiry
  std::uint8_t error_code() const { return error_code_; }    ///< of kRefused
  const LssIdentity& identity() const { return identity_; }  ///< of fastscan or select

 private:
  enum class Service : std::uint8_t {
    kNone,
    kSwitchAll,
    kSelect,
    kConfigureNodeId,
    kStore,
    kInquire,
    kFastscan
  };

  bool begin(LocalTime now, Service service);
  void send(LocalTime now, std::uint8_t command, std::uint32_t data, LocalTime wait);
  void send_scan(LocalTime now);
  void next_scan(LocalTime now, bool answered);

  Options options_{};
  Status status_ = Status::kIdle;
  Service service_ = Service::kNone;
  std::uint8_t expected_ = 0, error_code_ = 0;
  std::uint32_t value_ = 0;
  LssIdentity identity_{};
  LocalTime due_{0};
  std::array<CanFrame, 4> requests_{};
  std::size_t request_count_ = 0, request_at_ = 0;
  // Fastscan: the part, the bit under test (128: is anybody there; 0..31), and an answer seen.
  std::uint8_t scan_part_ = 0, scan_bit_ = 0;
  bool confirming_ = false, answered_ = false;
};

}  // namespace kinebus
