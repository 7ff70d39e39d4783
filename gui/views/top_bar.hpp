#pragma once
// Always visible: the machine's state in plain words and colour, the connection, and Stop.

#include <QColor>
#include <QFont>
#include <QMenu>
#include <QPaintEvent>
#include <QPushButton>
#include <QSize>
#include <QTimer>
#include <QToolButton>
#include <QWidget>

#include "gui/views/desk.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

/// The state as a coloured pill.
class StateChip : public QWidget {
  Q_OBJECT
 public:
  explicit StateChip(QWidget* parent = nullptr);
  void set(const QString& words, const QColor& colour);
  const QString& words() const { return words_; }
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QFont chip_font() const;
  QString words_;
  QColor colour_;
};

class TopBar : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit TopBar(Desk& desk, QWidget* parent = nullptr);
  QPushButton& stop_button() { return *stop_; }
  const StateChip& chip() const { return *chip_; }

 signals:
  void theme_chosen(bool dark);
  void language_chosen(const QString& code);
  void gateways_wanted();

 private:
  void take();
  void colour_stop();

  Desk& desk_;
  StateChip* chip_;
  ElidedLabel* doing_;
  QToolButton *connection_, *language_, *theme_;
  QPushButton *control_, *stop_;
  QMenu* languages_;
  QTimer silence_;  ///< the words tell how long, while the link is lost
};

}  // namespace kinebus::gui
