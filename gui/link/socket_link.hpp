#pragma once
// A gateway on this computer, by its local socket.

#include <QLocalSocket>
#include <QString>

#include "gui/link/link.hpp"

namespace kinebus::gui {

class SocketLink : public Link {
  Q_OBJECT
 public:
  explicit SocketLink(QString path, QObject* parent = nullptr);
  ~SocketLink() override;
  void open() override;
  qint64 write(const char* data, qint64 size) override;
  Phrase description() const override;

 private:
  static Phrase words_of(QLocalSocket::LocalSocketError error);
  /// More than this waits in the socket's own buffer: the caller has to wait, so that urgent commands stay
  /// quick.
  static constexpr qint64 kMaxWaiting_bytes = qint64{512} * 1024;
  QString path_;
  QLocalSocket socket_;
  bool full_ = false;
};

}  // namespace kinebus::gui
