#include "gui/link/hand/space_mouse.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>

namespace kinebus::gui {
namespace {
using namespace std::chrono_literals;

constexpr auto kLookAgain = 2s;
/// While it is deflected the driver says so some sixty times a second: a device that is silent is gone.
constexpr auto kSilence = 150ms;
/// Of a SpaceMouse that is pushed all the way.
constexpr float kFull = 350;

struct Packet {
  std::int32_t type = 0;             ///< 0: motion, 1: a button is pressed, 2: it is released
  std::int32_t x = 0, y = 0, z = 0;  ///< right, up, towards the user
  std::int32_t around_x = 0, around_y = 0, around_z = 0;
  std::int32_t period_ms = 0;
};
static_assert(sizeof(Packet) == 32);

float share(std::int32_t value) {
  return std::clamp(static_cast<float>(value) / kFull, -1.0F, 1.0F);
}

}  // namespace

SpaceMouse::SpaceMouse(const QString& socket, QObject* parent)
    : JogDevice(parent),
      path_(socket.isEmpty() ? QStringLiteral("/var/run/spnav.sock") : socket),
      socket_(this),
      again_(this),
      silence_(this) {
  again_.setInterval(kLookAgain);
  silence_.setSingleShot(true);
  silence_.setInterval(kSilence);
  connect(&again_, &QTimer::timeout, this, &SpaceMouse::look);
  connect(&silence_, &QTimer::timeout, this, &SpaceMouse::rest);
  connect(&socket_, &QLocalSocket::connected, this, &JogDevice::name_changed);
  connect(&socket_, &QLocalSocket::readyRead, this, &SpaceMouse::read);
  connect(&socket_, &QLocalSocket::disconnected, this, [this] {
    rest();
    emit name_changed();
  });
}

QString SpaceMouse::name() const {
  return socket_.state() == QLocalSocket::ConnectedState ? tr("3D mouse") : QString();
}

void SpaceMouse::listen(bool wanted) {
  if (wanted == wanted_) return;
  wanted_ = wanted;
  if (wanted) {
    look();
    again_.start();
    return;
  }
  again_.stop();
  socket_.abort();
}

void SpaceMouse::look() {
  if (socket_.state() == QLocalSocket::UnconnectedState) socket_.connectToServer(path_);
}

void SpaceMouse::rest() {
  silence_.stop();
  bytes_.clear();
  emit deflected({});
}

void SpaceMouse::read() {
  bytes_ += socket_.readAll();
  Deflection newest{};
  bool moved = false;
  for (; bytes_.size() >= static_cast<qsizetype>(sizeof(Packet)); bytes_.remove(0, sizeof(Packet))) {
    Packet packet;
    std::memcpy(&packet, bytes_.constData(), sizeof packet);
    if (packet.type != 0) continue;
    moved = true;
    newest = {share(packet.x),        share(-packet.z),       share(packet.y),
              share(packet.around_x), share(packet.around_y), 0};
  }
  if (!moved) return;
  silence_.start();
  emit deflected(newest);
}

}  // namespace kinebus::gui
