#include "gui/session/jog_drive.hpp"

#include <QPointer>
#include <QtMath>
#include <chrono>
#include <cmath>

#include "gui/session/gateway_words.hpp"

namespace kinebus::gui {
namespace {
using namespace std::chrono_literals;

constexpr float kDead = 0.2F;    ///< of all it can: a hand that rests on it
constexpr float kFast = 0.65F;   ///< from here on with full speed
constexpr float kOther = 0.15F;  ///< so much more another axis needs to take over
constexpr double kSlow = 0.2;    ///< of full speed
/// The gateway ends a jog of which it has not heard for 200 ms.
constexpr auto kAgain = 60ms;
/// Farther than any machine goes: mm, and a turn in degrees.
constexpr double kFar = 1000;
constexpr double kFarTurn = 360;
}  // namespace

JogDrive::JogDrive(Session& session, QObject* parent) : QObject(parent), session_(session), again_(this) {
  again_.setInterval(kAgain);
  connect(&again_, &QTimer::timeout, this, &JogDrive::ask);
  connect(&session, &Session::status_changed, this, &JogDrive::step);
  connect(&session, &Session::link_changed, this, [this] {
    if (session_.connected()) return;
    again_.stop();
    stage_ = Stage::kRest;
    until_rest_ = wanted_.has_value();
  });
}

std::optional<JogDrive::Way> JogDrive::way_of(const JogDevice::Deflection& deflection) const {
  const auto size = [&](int axis) { return std::abs(deflection[static_cast<std::size_t>(axis)]); };
  int most = 0;
  for (int axis = 1; axis < JogDevice::kAxes; ++axis)
    if (size(axis) > size(most)) most = axis;
  // A hand is never quite straight.
  if (wanted_ && size(wanted_->axis) > kDead && size(most) < size(wanted_->axis) + kOther)
    most = wanted_->axis;
  if (size(most) < kDead) return std::nullopt;
  return Way{most, deflection[static_cast<std::size_t>(most)] > 0 ? 1 : -1, size(most) >= kFast};
}

void JogDrive::take(const JogDevice::Deflection& deflection) {
  wanted_ = way_of(deflection);
  if (!wanted_) until_rest_ = false;
  step();
}

void JogDrive::let_go() {
  until_rest_ = wanted_.has_value();
  step();
}

void JogDrive::step() {
  const bool wants = wanted_ && !until_rest_;
  switch (stage_) {
    case Stage::kRest:
      if (!wants || session_.status().state() != joblink::STATE_READY ||
          !session_.allowed(joblink::COMMAND_JOG))
        return;
      way_ = *wanted_;
      stage_ = Stage::kMoves;
      again_.start();
      return ask();
    case Stage::kMoves:
      if (!wants || way_ != *wanted_) end();
      return;
    case Stage::kEnds:
      return;
    case Stage::kStills:
      if (session_.status().state() == joblink::STATE_MOVING ||
          session_.status().state() == joblink::STATE_CANCELLING)
        return;
      stage_ = Stage::kRest;
      return step();
  }
}

void JogDrive::ask() {
  if (stage_ != Stage::kMoves) return again_.stop();
  const bool turn = way_.axis == JogDevice::kA || way_.axis == JogDevice::kC;
  send(turn ? kFarTurn : kFar, [self = QPointer<JogDrive>(this)](const joblink::Reply& reply) {
    if (self.isNull() || !reply.has_error() || self->stage_ != Stage::kMoves) return;
    // At the end of its way, or refused: not again before the hand has let go.
    self->until_rest_ = true;
    self->end();
    emit self->session_.refused(to_words(reply.error()));
  });
}

void JogDrive::end() {
  again_.stop();
  stage_ = Stage::kEnds;
  send(0, [self = QPointer<JogDrive>(this)](const joblink::Reply&) {
    if (self.isNull() || self->stage_ != Stage::kEnds) return;
    self->stage_ = Stage::kStills;
  });
}

/// `distance`: mm or degrees, at least 0.
void JogDrive::send(double distance, Session::AnswerHandler then) {
  const double step = distance * way_.sign;
  double speed = full_per_s_ * (way_.fast ? 1 : kSlow);
  joblink::Pose delta;
  switch (way_.axis) {
    case JogDevice::kX:
      delta.set_x_mm(step);
      break;
    case JogDevice::kY:
      delta.set_y_mm(step);
      break;
    case JogDevice::kZ:
      delta.set_z_mm(step);
      break;
    case JogDevice::kA:
      delta.set_a_rad(qDegreesToRadians(step));
      speed = qDegreesToRadians(speed);
      break;
    case JogDevice::kC:
      delta.set_c_rad(qDegreesToRadians(step));
      speed = qDegreesToRadians(speed);
      break;
    default:
      delta.set_e_mm(step);
      break;
  }
  session_.jog(delta, speed, true, std::move(then));
}

}  // namespace kinebus::gui
