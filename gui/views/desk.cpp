#include "gui/views/desk.hpp"

#include <QObject>
#include <QString>

#include "gui/link/socket_link.hpp"

namespace kinebus::gui {

void Desk::connect_to(const FoundGateway& gateway) {
  demo.reset();
  session.connect_to([this, gateway] { return finder.link_to(gateway); }, gateway.title);
}

void Desk::start_demo(const std::function<void(const QString&)>& failed, const QString& machine_file) {
  session.disconnect_from_gateway();
  demo = std::make_unique<DemoGateway>();
  QObject::connect(demo.get(), &DemoGateway::failed, &session, failed);
  QObject::connect(demo.get(), &DemoGateway::ready, &session, [this] {
    const QString socket = demo->socket_path();
    session.connect_to([socket] { return std::make_unique<SocketLink>(socket); },
                       Phrase("Desk", QT_TRANSLATE_NOOP("Desk", "Demo machine")));
  });
  demo->start(machine_file);
}

}  // namespace kinebus::gui
