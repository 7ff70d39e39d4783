#pragma once
// What the gateway refuses or alarms about, over the page: nothing moves under the pointer when it comes or
// goes.

#include <QEvent>
#include <QLabel>
#include <QObject>
#include <QString>
#include <QTimer>
#include <QWidget>

#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class Notice : public SpeakingWidget {
  Q_OBJECT
 public:
  /// Stands at the upper edge of `room`, as wide as it.
  Notice(const Theme& theme, QWidget* room);
  /// Goes by itself after a while.
  void tell(const QString& words);
  /// Stays until end_alarm() or until the user closes it.
  void tell_alarm(const QString& words);
  void end_alarm();
  bool of_alarm() const { return alarm_ && isVisible(); }
  QString words() const { return text_->text(); }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void go();
  void appear(const QString& words);
  void place();

  QLabel* text_;
  QTimer timer_;
  bool alarm_ = false;
};

}  // namespace kinebus::gui
