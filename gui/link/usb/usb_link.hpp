#pragma once
// A gateway on the USB cable: bulk transfers to and from its job link interface. libusb's thread completes
// them and hands the bytes over to this object's thread.

#include <QObject>
#include <QString>

#include <memory>

#include "gui/link/link.hpp"
#include "gui/link/usb/usb_watch.hpp"

namespace kinebus::gui {

class UsbLink : public Link {
  Q_OBJECT
 public:
  UsbLink(std::shared_ptr<UsbContext> context, UsbGateway gateway, QObject* parent = nullptr);
  ~UsbLink() override;
  void open() override;
  qint64 write(const char* data, qint64 size) override;
  Phrase description() const override;

  class Pipe;  ///< handle and transfers; outlives the link until the last transfer is back

 private:
  void fail(const Phrase& why);

  std::shared_ptr<UsbContext> context_;
  UsbGateway gateway_;
  std::shared_ptr<Pipe> pipe_;
};

}  // namespace kinebus::gui
