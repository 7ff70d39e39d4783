#pragma once
// A whole machine to try without hardware: kinebusd with simulated nodes, as a child with a folder of its own
// that goes when it ends.

#include <QObject>
#include <QProcess>
#include <QTemporaryDir>

namespace kinebus::gui {

class DemoGateway : public QObject {
  Q_OBJECT
 public:
  explicit DemoGateway(QObject* parent = nullptr);
  ~DemoGateway() override;
  /// ready() or failed() follows. `machine_file`: another than the machine that a new gateway has.
  void start(const QString& machine_file = {});
  QString socket_path() const;
  /// Beside this program, then in PATH; empty: there is none.
  static QString find_daemon();

 signals:
  void ready();
  void failed(const QString& why);

 private:
  void look_for_socket();

  QTemporaryDir folder_;
  QProcess process_;
  int looks_ = 0;
};

}  // namespace kinebus::gui
