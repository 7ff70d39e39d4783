#include "gateway/devices/heat_node_tuning.hpp"

#include <cmath>
#include <utility>

#include "protocol/canopen/heat_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;
using namespace heat_object;

constexpr BusTime kLook = 250ms;
constexpr BusTime kStoreAgain = 500ms;
constexpr std::array kModel{kModelRate, kModelLoss, kModelLag, kModelDead};

// What 2225h says: low nibble, high nibble.
constexpr std::uint32_t kStateIdle = 0, kStateHeats = 1, kStateCoasts = 2, kStateFits = 3, kStateDone = 4;
enum Failure : std::uint32_t { kTooNear = 1, kNoRise = 2, kTooLong = 3, kTooHot = 4, kNoModel = 5 };

Sentence why(std::uint32_t failure) {
  switch (failure) {
    case kTooNear:
      return say("the way to the temperature is too short to measure anything: let it cool first");
    case kNoRise:
      return say(
          "full power does not warm its sensor: look whether heater and sensor are plugged in, and in "
          "their places");
    case kTooLong:
      return say(
          "it was not half the way up after 20 minutes: choose a lower temperature, or look at its "
          "supply and its power");
    case kTooHot:
      return say("it would have gone above its limit: choose a lower temperature");
    case kNoModel:
      return say(
          "its curve is not that of a heater: look for a loose heater or sensor, a fan or a draught, "
          "then measure again");
    default:
      return say("its node gives no reason");
  }
}

bool is_no_answer(AbortCode code) {
  return code == AbortCode::kTimeout || code == AbortCode::kToggleBit || code == AbortCode::kCommandSpecifier;
}

}  // namespace

void HeatNodeTuning::begin(BusTime now, std::size_t heater, double celsius, double power_w) {
  told_ = {};
  told_.stage = TuningStage::kBegins;
  told_.celsius = celsius;
  heater_ = heater;
  power_w_ = power_w;
  due_ = heard_ = now;
  read_ = 0;
}

void HeatNodeTuning::end(Sentence reason) {
  if (!runs()) return;
  told_.stage = TuningStage::kFailed;
  told_.failure = std::move(reason);
}

std::optional<HeatNodeTuning::Question> HeatNodeTuning::next(BusTime now) const {
  if (!runs() || now < due_) return std::nullopt;
  const auto of_heater = [this](ObjectAddress first) {
    return ObjectAddress{first.index, static_cast<std::uint8_t>(first.subindex + heater_)};
  };
  switch (told_.stage) {
    case TuningStage::kBegins:
      return Question{of_heater(kTune), 2, true, static_cast<std::uint32_t>(std::lround(10 * told_.celsius))};
    case TuningStage::kKeeps:
      if (read_ < kModel.size()) return Question{of_heater(kModel[read_]), 4};
      return Question{object::kStoreParameters, 4, true, static_cast<std::uint32_t>(kSaveSignature)};
    default:
      return Question{of_heater(kTuneState), 1};
  }
}

void HeatNodeTuning::on_answer(BusTime now, AbortCode code, std::uint32_t value) {
  if (!runs()) return;
  if (is_no_answer(code)) return on_silence(now, code);
  heard_ = now;
  if (told_.stage == TuningStage::kKeeps && read_ == kModel.size()) return on_stored(now, code);
  if (code != AbortCode::kNone) return end(say("its node refuses to measure it: %1", text(code)));
  if (told_.stage == TuningStage::kBegins) {
    told_.stage = TuningStage::kHeats;
    due_ = now + kLook;
  } else if (told_.stage == TuningStage::kKeeps) {
    found_[read_++] = value;
    if (read_ < kModel.size()) return;
    store_since_ = now;
    take_model();
  } else {
    take_state(now, value);
  }
}

void HeatNodeTuning::take_state(BusTime now, std::uint32_t state) {
  due_ = now + kLook;
  switch (state & 0xF) {
    case kStateIdle:
      return end(say("its node has ended it: see its alarms, or measure it again"));
    case kStateHeats:
      told_.stage = TuningStage::kHeats;
      return;
    case kStateCoasts:
      told_.stage = TuningStage::kCools;
      return;
    case kStateFits:
      told_.stage = TuningStage::kFits;
      return;
    case kStateDone:
      told_.stage = TuningStage::kKeeps;
      due_ = now;
      return;
    default:
      return end(why(state >> 4));
  }
}

/// What a rate of so many K/s at full power and a loss of so many 1/s are in the units of physics.
void HeatNodeTuning::take_model() {
  const double capacity = found_[0] > 0 ? power_w_ / (found_[0] * 1e-3) : 0;
  told_.model = {.power_w = power_w_,
                 .capacity_j_per_k = capacity,
                 .loss_w_per_k = found_[1] * 1e-6 * capacity,
                 .lag_s = found_[2] * 1e-3,
                 .dead_s = found_[3] * 1e-3};
}

/// In force it is already.
void HeatNodeTuning::on_stored(BusTime now, AbortCode code) {
  if (code != AbortCode::kNone && now - store_since_ < kStoring) {
    due_ = now + kStoreAgain;  // it writes, or something else heats
    return;
  }
  told_.stage = TuningStage::kDone;
  if (code != AbortCode::kNone)
    told_.failure = say("its node did not store it, and forgets it without power: %1", text(code));
}

void HeatNodeTuning::on_silence(BusTime now, AbortCode code) {
  const bool stores = told_.stage == TuningStage::kKeeps && read_ == kModel.size();
  if (stores) return on_stored(now, code);
  if (now - heard_ > kSilence) return end(say("its node does not answer: %1", text(code)));
  // Whether the request came through shows in the node's state.
  if (told_.stage == TuningStage::kBegins) told_.stage = TuningStage::kHeats;
}

}  // namespace kinebus
