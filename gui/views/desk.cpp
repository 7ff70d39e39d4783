#include "gui/views/desk.hpp"

#include "gui/link/socket_link.hpp"

namespace kinebus::gui {

void Desk::start_demo(const std::function<void(const QString&)>& failed) {
  session.disconnect_from_gateway();
  demo = std::make_unique<DemoGateway>();
  QObject::connect(demo.get(), &DemoGateway::failed, &session, failed);
  QObject::connect(demo.get(), &DemoGateway::ready, &session, [this] {
    const QString path = demo->socket_path();
    session.connect_to([path] { return std::make_unique<SocketLink>(path); },
                       QCoreApplication::translate("Desk", "Demo machine"));
  });
  demo->start();
}

}  // namespace kinebus::gui
