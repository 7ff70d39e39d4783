#pragma once
// A probe with a pin (BLTouch): a heat node's servo output moves the pin and reads whether it is where it was
// told to be; contacts are those of the probe's own input.

#include <memory>
#include <optional>
#include <utility>

#include "gateway/devices/heat_node_devices.hpp"

namespace kinebus {

class BltouchProbe : public ContactProbe {
 public:
  BltouchProbe(std::unique_ptr<ContactProbe> contact, std::shared_ptr<HeatNodeLink> node)
      : contact_(std::move(contact)), node_(std::move(node)) {}
  bool on_frame(BusTime now, const CanFrame& frame) override { return contact_->on_frame(now, frame); }
  /// Nobody knows how it was left: in.
  void on_bring_up(BusTime now, bool done) override {
    contact_->on_bring_up(now, done);
    if (done) node_->move_pin(PinOrder::kIn);
  }
  bool touches() const override { return contact_->touches(); }
  void arm(bool away) override { contact_->arm(away); }
  void ask() override { contact_->ask(); }
  Watch watch() const override { return contact_->watch(); }
  BusTime contact() const override { return contact_->contact(); }
  std::optional<ProbeRequest> next_request() override { return contact_->next_request(); }
  void on_reply(BusTime now, std::optional<std::int64_t> value) override { contact_->on_reply(now, value); }
  void move_pin(PinOrder order) override { node_->move_pin(order); }
  std::optional<Sentence> absent() const override { return node_->absent(); }
  Pin pin() const override { return node_->pin(); }
  Sentence pin_words() const override { return node_->pin_words(); }

 private:
  std::unique_ptr<ContactProbe> contact_;
  std::shared_ptr<HeatNodeLink> node_;
};

}  // namespace kinebus
