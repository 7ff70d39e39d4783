#include "gui/link/socket_link.hpp"

#include <QObject>
#include <QString>

#include <algorithm>

namespace kinebus::gui {
namespace {
constexpr const char* kSocketWords = "kinebus::gui::SocketLink";
}  // namespace

Phrase SocketLink::words_of(QLocalSocket::LocalSocketError error) {
  switch (error) {
    case QLocalSocket::ServerNotFoundError:
    case QLocalSocket::ConnectionRefusedError:
      return {kSocketWords, QT_TRANSLATE_NOOP("kinebus::gui::SocketLink", "no gateway runs there")};
    case QLocalSocket::SocketAccessError:
      return {kSocketWords,
              QT_TRANSLATE_NOOP("kinebus::gui::SocketLink", "this user may not use the gateway's socket")};
    default:
      return {kSocketWords,
              QT_TRANSLATE_NOOP("kinebus::gui::SocketLink", "the connection on this computer has failed")};
  }
}

SocketLink::SocketLink(QString path, QObject* parent) : Link(parent), path_(std::move(path)), socket_(this) {
  connect(&socket_, &QLocalSocket::connected, this, &Link::opened);
  connect(&socket_, &QLocalSocket::disconnected, this, [this] {
    emit closed(
        {kSocketWords, QT_TRANSLATE_NOOP("kinebus::gui::SocketLink", "the gateway closed the connection")});
  });
  connect(&socket_, &QLocalSocket::errorOccurred, this, [this](QLocalSocket::LocalSocketError error) {
    if (error != QLocalSocket::PeerClosedError) emit closed(words_of(error));
  });
  connect(&socket_, &QLocalSocket::readyRead, this, [this] { emit received(socket_.readAll()); });
  connect(&socket_, &QLocalSocket::bytesWritten, this, [this] {
    if (!full_ || socket_.bytesToWrite() > kMaxWaiting_bytes / 2) return;
    full_ = false;
    emit drained();
  });
}

SocketLink::~SocketLink() {
  socket_.disconnect(this);  // its own end is no news
}

void SocketLink::open() {
  socket_.connectToServer(path_);
}

qint64 SocketLink::write(const char* data, qint64 size) {
  if (socket_.state() != QLocalSocket::ConnectedState) return 0;
  const qint64 room = std::max<qint64>(0, kMaxWaiting_bytes - socket_.bytesToWrite());
  const qint64 taken = socket_.write(data, std::min(size, room));
  full_ = taken < size;
  return std::max<qint64>(0, taken);
}

Phrase SocketLink::description() const {
  return {kSocketWords, QT_TRANSLATE_NOOP("kinebus::gui::SocketLink", "on this computer")};
}

}  // namespace kinebus::gui
