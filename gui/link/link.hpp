#pragma once
// Bytes to a gateway and back, whatever carries them. A link is opened once; when it breaks it says so and is
// done.

#include <QByteArray>
#include <QObject>

#include "gui/link/phrase.hpp"

namespace kinebus::gui {

class Link : public QObject {
  Q_OBJECT
 public:
  using QObject::QObject;
  /// opened() or closed() follows.
  virtual void open() = 0;
  /// Takes at most `size` bytes; returns how many were taken. Fewer: drained() tells when to go on.
  virtual qint64 write(const char* data, qint64 size) = 0;
  /// What the user sees: "local", "USB 1-2".
  virtual Phrase description() const = 0;

 signals:
  void opened();
  void closed(const kinebus::gui::Phrase& why);
  void received(const QByteArray& bytes);
  void drained();
};

}  // namespace kinebus::gui
