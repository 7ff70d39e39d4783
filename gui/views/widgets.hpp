#pragma once
// Small pieces that the pages are made of.

#include <QBoxLayout>
#include <QComboBox>
#include <QEvent>
#include <QFrame>
#include <QGridLayout>
#include <QLabel>
#include <QPaintEvent>
#include <QPushButton>
#include <QSize>
#include <QSlider>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWidget>
#include <functional>
#include <vector>

namespace kinebus::gui {

class Theme;

/// A widget that says its words again when the language changes.
class SpeakingWidget : public QWidget {
  Q_OBJECT
 public:
  using QWidget::QWidget;

 protected:
  /// Does `say` now and after every change of language.
  void says(std::function<void()> say);
  void changeEvent(QEvent* event) override;

 private:
  std::vector<std::function<void()>> sayings_;
};

/// A white (or dark) box with rounded corners.
class Card : public QFrame {
  Q_OBJECT
 public:
  explicit Card(QWidget* parent = nullptr);
  QVBoxLayout* column() const { return column_; }

 private:
  QVBoxLayout* column_;
};

/// role: title, heading, muted, small, danger.
QLabel* make_label(const char* role, QWidget* parent = nullptr);
void set_role(QWidget* widget, const char* property, const QString& value);
/// Breaks its lines between words, and shows them whole in languages from right to left, too.
void wrap_words(QLabel& label);
/// Puts a value at the end of its column, by the direction of the language at work.
void align_trailing(QLabel& label);
/// Fills a horizontal slider from the side where the language at work begins.
void speak_direction(QSlider& slider);

/// Draws its icon and words together in the middle, in the order of the language.
class IconButton : public QPushButton {
  Q_OBJECT
 public:
  IconButton(const Theme& theme, QWidget* parent) : QPushButton(parent), theme_(theme) {}

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  const Theme& theme_;
};

/// A push button whose icon follows the theme.
QPushButton* make_button(const Theme& theme, const QString& icon, const char* kind = "",
                         QWidget* parent = nullptr);
/// The wheel turns a slider or a choice only while it has the focus; else the page scrolls.
void turn_with_focus_only(QWidget& widget);
/// A button that can do nothing now tells why, instead of what it does; `why_not` may be empty.
void set_usable(QAbstractButton& button, bool can, const QString& why_not);
QToolButton* make_tool(const Theme& theme, const QString& icon, bool checkable, QWidget* parent = nullptr);

/// A label whose text is cut with dots instead of widening its window.
class ElidedLabel : public QLabel {
  Q_OBJECT
 public:
  using QLabel::QLabel;
  void set_text(const QString& text);
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
};

}  // namespace kinebus::gui
