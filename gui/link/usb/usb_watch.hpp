#pragma once
// Which gateways are plugged in, by libusb's hot-plug news. libusb works in one thread of its own, which also
// carries the transfers of all links.

#include <QObject>
#include <QVector>
#include <atomic>
#include <memory>
#include <thread>

struct libusb_context;

namespace kinebus::gui {

struct UsbGateway {
  QString serial;  ///< of the device; empty when it cannot be read
  QString place;   ///< "1-2": bus and ports, stays the same while plugged in
  QString product;
  friend bool operator==(const UsbGateway&, const UsbGateway&) = default;
};

/// libusb and its thread. Its end waits until every transfer of every link has come back.
class UsbContext {
 public:
  UsbContext();
  ~UsbContext();
  UsbContext(const UsbContext&) = delete;
  UsbContext& operator=(const UsbContext&) = delete;
  libusb_context* get() const { return context_; }
  std::atomic<int> open_pipes{0};

 private:
  libusb_context* context_ = nullptr;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

class UsbWatch : public QObject {
  Q_OBJECT
 public:
  explicit UsbWatch(QObject* parent = nullptr);
  ~UsbWatch() override;
  const QVector<UsbGateway>& gateways() const { return gateways_; }
  std::shared_ptr<UsbContext> context() const { return context_; }

 signals:
  void changed();

 private:
  Q_INVOKABLE void look_again();

  std::shared_ptr<UsbContext> context_;
  int callback_ = 0;
  QVector<UsbGateway> gateways_;
};

}  // namespace kinebus::gui
