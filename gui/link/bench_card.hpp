#pragma once
// One driver card on a bench, without gateway and machine file: kinebus-card as a child that is spoken to by
// lines. It ends with this; a motor that moves stops then by its ramp.

#include <QJsonObject>
#include <QObject>
#include <QProcess>
#include <QString>
#include <QStringList>

namespace kinebus::gui {

class BenchCard : public QObject {
  Q_OBJECT
 public:
  /// `program`: kinebus-card; empty: there is none, which start() tells.
  explicit BenchCard(QString program, QObject* parent = nullptr);
  ~BenchCard() override;

  void start(const QString& can_interface, int node);
  void end();
  bool runs() const { return process_.state() != QProcess::NotRunning; }
  /// A command has been given and nothing has been told of it yet.
  bool busy() const { return open_ > 0; }
  /// "jog A 51200 51200", as tools/card/card_session.hpp has them.
  void send(const QString& line);

  /// Beside this program, then in PATH; empty: there is none.
  static QString find_program();
  /// CAN interfaces of this computer.
  static QStringList interfaces();

 signals:
  void state_told(const QJsonObject& state);
  void done(const QString& what, const QJsonObject& found);
  void refused(const QString& why);
  /// The node does not answer; it is asked again by itself.
  void silent(const QString& why);
  /// `why`: empty when it was ended.
  void ended(const QString& why);

 private:
  void read();
  void take(const QByteArray& line);

  QString program_;
  QProcess process_;
  int open_ = 0;
  bool wanted_ = false;  ///< it is to run
};

}  // namespace kinebus::gui
