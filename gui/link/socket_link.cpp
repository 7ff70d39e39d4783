#include "gui/link/socket_link.hpp"

#include <QObject>
#include <QString>

#include <algorithm>

namespace kinebus::gui {

QString SocketLink::words_of(QLocalSocket::LocalSocketError error) {
  switch (error) {
    case QLocalSocket::ServerNotFoundError:
    case QLocalSocket::ConnectionRefusedError:
      return tr("no gateway runs there");
    case QLocalSocket::SocketAccessError:
      return tr("this user may not use the gateway's socket");
    default:
      return tr("the connection on this computer has failed");
  }
}

SocketLink::SocketLink(QString path, QObject* parent) : Link(parent), path_(std::move(path)), socket_(this) {
  connect(&socket_, &QLocalSocket::connected, this, &Link::opened);
  connect(&socket_, &QLocalSocket::disconnected, this,
          [this] { emit closed(tr("the gateway closed the connection")); });
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

QString SocketLink::description() const {
  return tr("on this computer");
}

}  // namespace kinebus::gui
