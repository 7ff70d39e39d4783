#pragma once
// The least node that SDO server and PDO engine can be fuzzed with: dictionary, server, PDOs, and an owner
// that agrees to everything.

#include <cstdint>

#include "protocol/canopen/pdo_engine.hpp"
#include "protocol/canopen/sdo_server.hpp"

namespace kinebus {

class DictionaryNode : public ObjectOwner {
 public:
  DictionaryNode() {
    server.reset(1);
    pdos.configure();
    pdos.set_operational(true, LocalTime{0});
  }
  AbortCode read(const ObjectEntry& entry, std::int64_t& value) override {
    value = static_cast<std::int64_t>(entry.address.key());
    return AbortCode::kNone;
  }
  AbortCode write(const ObjectEntry& entry, std::int64_t value) override {
    return PdoEngine::owns(entry.address) ? pdos.accept(entry, value) : AbortCode::kNone;
  }

  NodeDictionary objects{*this, 1};
  PdoEngine pdos{objects};
  SdoServer server{objects};
};

/// Cuts fuzzer input into frames: 1 byte what, 8 bytes data.
class FrameSource {
 public:
  FrameSource(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}
  bool next(std::uint8_t& kind, CanFrame& frame) {
    if (bytes_.size() < 9) return false;
    kind = bytes_[0];
    frame = CanFrame::from_bytes(0, bytes_.subspan(1, 8));
    bytes_ = bytes_.subspan(9);
    return true;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace kinebus
