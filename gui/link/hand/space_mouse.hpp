#pragma once
// A 3D mouse as spacenavd (or 3Dconnexion's driver in its place) tells of it: packets of eight integers on a
// local socket. https://spacenav.sourceforge.net: protocol version 0.

#include <QByteArray>
#include <QLocalSocket>
#include <QTimer>

#include "gui/link/hand/jog_device.hpp"

namespace kinebus::gui {

class SpaceMouse : public JogDevice {
  Q_OBJECT
 public:
  /// `socket`: of the driver; empty: where it listens on this system.
  explicit SpaceMouse(const QString& socket = {}, QObject* parent = nullptr);
  QString name() const override;
  bool has_dead_man() const override { return false; }
  void listen(bool wanted) override;

 private:
  void look();
  void read();
  void rest();

  QString path_;
  QLocalSocket socket_;
  QTimer again_, silence_;
  QByteArray bytes_;
  bool wanted_ = false;
};

}  // namespace kinebus::gui
