#pragma once
// The PDOs of a node: what 1400h, 1600h, 1800h and 1A00h ff. say, carried out. Parameters live in the object
// dictionary; writes to them come here first (accept), to be checked by CiA 301's rules and to take effect.

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/canopen/object_dictionary.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class PdoEngine {
 public:
  /// What went wrong, to be told by EMCY; pull until empty.
  struct Problem {
    std::uint16_t emcy_code =
        0;                   ///< 8200h refused value, 8210h too short, 8220h too long, 8250h RPDO timeout
    std::uint8_t rpdo = 0;   ///< 1..
    ObjectAddress object{};  ///< of a refused value
  };
  enum class Reception : std::uint8_t { kNotMine, kWritten, kAwaitsSync, kRefused };

  explicit PdoEngine(ObjectDictionary& objects) : objects_(objects) {}

  /// Reads all parameters from the dictionary (after reset, restore, or a change of node id). PDOs whose
  /// parameters make no sense are off.
  void configure();

  static constexpr bool owns(ObjectAddress address) {
    return address.index >= 0x1400 && address.index < 0x1C00;
  }
  /// To be called from ObjectOwner::write for an object that the engine owns.
  AbortCode accept(const ObjectEntry& entry, std::int64_t value);

  /// PDOs run in NMT operational only. On entry event-driven TPDOs are due once.
  void set_operational(bool operational, LocalTime now);

  Reception on_frame(LocalTime now, const CanFrame& frame);
  /// Synchronous RPDOs received since the last SYNC take effect, and synchronous TPDOs become due. `counter`:
  /// 0 without SYNC counter.
  void on_sync(LocalTime now, std::uint8_t counter);
  /// Timers; and looks for changed values of TPDOs of type 255 (the device profile's event). Cheap enough to
  /// call after every input.
  void on_time(LocalTime now);
  /// The application's event for TPDO `number` (1..4); types 0, 254 and 255. Of type 254 it is, with the
  /// event timer, the only one (manufacturer-specific); 0 and 255 also go by the change of a mapped value.
  void trigger(int number);

  std::optional<CanFrame> next_frame(LocalTime now);
  LocalTime next_deadline() const;
  std::optional<Problem> next_problem();

  /// An RPDO is overdue (its event timer), until one comes.
  bool rpdo_missing() const;
  bool rpdo_valid(int number) const { return rpdos_[static_cast<std::size_t>(number - 1)].valid; }
  bool tpdo_valid(int number) const { return tpdos_[static_cast<std::size_t>(number - 1)].valid; }

 private:
  struct MappedObject {
    std::int16_t place = -1;  // in the table; -1: dummy, bytes without meaning
    std::uint8_t bytes = 0;
  };
  struct Mapping8 {
    std::array<MappedObject, 8> objects{};
    std::uint8_t count = 0;
    std::uint8_t length = 0;  // bytes
  };
  struct Pdo {
    std::uint32_t cob_id = 0;  // 11 bits
    bool valid = false;
    std::uint8_t type = 255;
    LocalTime inhibit{0}, event{0};
    std::uint8_t sync_start = 0;
    Mapping8 map;
    // RPDO: a frame waiting for SYNC, deadline of the next. TPDO: bytes sent last, due, when it may and must
    // be sent.
    CanFrame frame;
    bool waiting = false;
    bool due = false;
    bool missing = false;
    LocalTime not_before{0};
    LocalTime timer = LocalTime::max();
    std::uint8_t syncs = 0;
    bool sync_started = false;
  };

  bool is_tpdo(ObjectAddress address) const { return address.index >= 0x1800; }
  Pdo* pdo_of(ObjectAddress address);
  std::int64_t parameter(std::uint16_t index, std::uint8_t subindex) const;
  AbortCode accept_communication(Pdo& pdo, const ObjectEntry& entry, std::int64_t value);
  AbortCode accept_mapping(Pdo& pdo, const ObjectEntry& entry, std::int64_t value);
  void load(Pdo& pdo, std::uint16_t communication_index, std::uint16_t mapping_index, bool tpdo);
  AbortCode resolve(std::uint32_t mapping, bool tpdo, MappedObject& object) const;
  AbortCode build_mapping(std::uint16_t mapping_index, int count, bool tpdo, Mapping8& map) const;
  void start(Pdo& pdo, bool tpdo, LocalTime now);
  Reception write(Pdo& pdo, const CanFrame& frame);
  bool pack(Pdo& pdo, CanFrame& frame);
  void report(std::uint16_t code, const Pdo& pdo, ObjectAddress object = {});

  ObjectDictionary& objects_;
  std::array<Pdo, kRpdoCount> rpdos_{};
  std::array<Pdo, kTpdoCount> tpdos_{};
  std::array<Problem, 4> problems_{};
  std::size_t problem_count_ = 0;
  bool operational_ = false;
  LocalTime now_{0};
};

}  // namespace kinebus
