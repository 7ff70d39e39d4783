#pragma once
// Which gateways can be reached now: on the USB cable, and by local sockets at the usual places.

#include <QFileSystemWatcher>
#include <QObject>
#include <QStringList>
#include <QTimer>
#include <QVector>
#include <memory>

#include "gui/link/phrase.hpp"
#include "gui/link/usb/usb_watch.hpp"

namespace kinebus::gui {

class Link;

struct FoundGateway {
  enum class Way { kUsb, kSocket } way{};
  Phrase title;   ///< what the user reads
  Phrase detail;  ///< serial number or path
  QString key;    ///< the same when it is found again
  UsbGateway usb;
  QString socket_path;
  friend bool operator==(const FoundGateway&, const FoundGateway&) = default;
};

class GatewayFinder : public QObject {
  Q_OBJECT
 public:
  /// more_sockets: paths that are offered besides the usual ones when something listens there.
  explicit GatewayFinder(QStringList more_sockets = {}, QObject* parent = nullptr);
  const QVector<FoundGateway>& gateways() const { return gateways_; }
  std::unique_ptr<Link> link_to(const FoundGateway& gateway) const;

 signals:
  void changed();

 private:
  void look();

  QStringList sockets_;
  QFileSystemWatcher folders_;
  QTimer again_;
  UsbWatch usb_;
  QVector<FoundGateway> gateways_;
};

}  // namespace kinebus::gui
