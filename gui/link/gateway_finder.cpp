#include "gui/link/gateway_finder.hpp"

#include <sys/stat.h>

#include <QFileInfo>
#include <QStringList>

#include "gui/link/socket_link.hpp"
#include "gui/link/usb/usb_link.hpp"

namespace kinebus::gui {
namespace {

QStringList usual_sockets() {
  QStringList paths;
  if (const QString named = qEnvironmentVariable("KINEBUS_SOCKET"); !named.isEmpty()) paths << named;
  if (const QString runtime = qEnvironmentVariable("XDG_RUNTIME_DIR"); !runtime.isEmpty())
    paths << runtime + QStringLiteral("/kinebus.sock");
  paths << QStringLiteral("/run/kinebus/kinebus.sock") << QStringLiteral("/tmp/kinebus.sock");
  return paths;
}

bool is_socket(const QString& path) {
  struct stat about {};
  return ::stat(path.toLocal8Bit().constData(), &about) == 0 && S_ISSOCK(about.st_mode);
}

}  // namespace

GatewayFinder::GatewayFinder(QStringList more_sockets, QObject* parent)
    : QObject(parent), sockets_(std::move(more_sockets)), folders_(this), again_(this), usb_(this) {
  sockets_ << usual_sockets();
  sockets_.removeDuplicates();
  for (const QString& path : std::as_const(sockets_))
    if (const QString folder = QFileInfo(path).path(); QFileInfo::exists(folder)) folders_.addPath(folder);
  // A busy folder such as /tmp tells of every change: look at most four times a second.
  again_.setSingleShot(true);
  again_.setInterval(250);
  connect(&folders_, &QFileSystemWatcher::directoryChanged, &again_, [this] {
    if (!again_.isActive()) again_.start();
  });
  connect(&again_, &QTimer::timeout, this, &GatewayFinder::look);
  connect(&usb_, &UsbWatch::changed, this, &GatewayFinder::look);
  look();
}

void GatewayFinder::look() {
  QVector<FoundGateway> found;
  for (const UsbGateway& usb : usb_.gateways()) {
    const QString serial = usb.serial.isEmpty() ? usb.place : usb.serial;
    found.push_back({.way = FoundGateway::Way::kUsb,
                     .title = Phrase(usb.product),
                     .detail = {"kinebus::gui::GatewayFinder",
                                QT_TRANSLATE_NOOP("kinebus::gui::GatewayFinder", "USB %1 · serial number %2"),
                                {usb.place, serial}},
                     .key = QStringLiteral("usb:") + serial,
                     .usb = usb,
                     .socket_path = {}});
  }
  for (const QString& path : std::as_const(sockets_))
    if (is_socket(path))
      found.push_back(
          {.way = FoundGateway::Way::kSocket,
           .title = {"kinebus::gui::GatewayFinder",
                     QT_TRANSLATE_NOOP("kinebus::gui::GatewayFinder", "Gateway on this computer")},
           .detail = Phrase(path),
           .key = QStringLiteral("socket:") + path,
           .usb = {},
           .socket_path = path});
  if (found == gateways_) return;
  gateways_ = std::move(found);
  emit changed();
}

std::unique_ptr<Link> GatewayFinder::link_to(const FoundGateway& gateway) const {
  if (gateway.way == FoundGateway::Way::kUsb) return std::make_unique<UsbLink>(usb_.context(), gateway.usb);
  return std::make_unique<SocketLink>(gateway.socket_path);
}

}  // namespace kinebus::gui
