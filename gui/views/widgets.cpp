#include "gui/views/widgets.hpp"

#include <QColor>
#include <QEvent>
#include <QIcon>
#include <QLatin1Char>
#include <QLatin1String>
#include <QLocale>
#include <QObject>
#include <QPaintEvent>
#include <QPainter>
#include <QRect>
#include <QRectF>
#include <QSize>
#include <QStyle>
#include <QStyleOptionButton>
#include <QStylePainter>
#include <QTextDocument>
#include <QTextLayout>
#include <QTextLine>
#include <QTextOption>
#include <QVBoxLayout>
#include <QWidget>

#include "gui/views/theme.hpp"

namespace kinebus::gui {

namespace {

class WheelWithFocus : public QObject {
 public:
  using QObject::QObject;
  bool eventFilter(QObject* watched, QEvent* event) override {
    const auto* widget = qobject_cast<QWidget*>(watched);
    if (event->type() != QEvent::Wheel || widget == nullptr || widget->hasFocus()) return false;
    event->ignore();  // its parent has it
    return true;
  }
};

/// Qt draws a wrapped line from right to left with the space that ends it before its first letter: the line
/// stands too far left, and its last letter outside of the label.
class LinesFromTheRight : public QObject {
 public:
  using QObject::QObject;
  bool eventFilter(QObject* watched, QEvent* event) override {
    auto* label = qobject_cast<QLabel*>(watched);
    if (event->type() != QEvent::Paint || label == nullptr || label->layoutDirection() != Qt::RightToLeft ||
        Qt::mightBeRichText(label->text()))
      return false;
    draw(*label);
    return true;
  }

 private:
  static void draw(QLabel& label) {
    const QRectF room = label.contentsRect();
    QString text = label.text();
    text.replace(QLatin1Char('\n'), QChar(QChar::LineSeparator));
    QTextOption option;
    option.setTextDirection(Qt::RightToLeft);
    option.setWrapMode(QTextOption::WordWrap);
    QTextLayout layout(text, label.font());
    layout.setTextOption(option);
    struct Line {
      QString words;
      double height = 0;
    };
    std::vector<Line> lines;
    double height = 0;
    layout.beginLayout();
    for (QTextLine line = layout.createLine(); line.isValid(); line = layout.createLine()) {
      line.setLineWidth(room.width());
      lines.push_back({text.mid(line.textStart(), line.textLength()).trimmed(), line.height()});
      height += line.height();
    }
    layout.endLayout();
    const Qt::Alignment wanted = label.alignment();
    double top = room.top();
    if ((wanted & Qt::AlignTop) == 0)
      top += (room.height() - height) / ((wanted & Qt::AlignBottom) != 0 ? 1 : 2);
    QPainter painter(&label);
    painter.setPen(label.palette().color(label.foregroundRole()));
    const Qt::Alignment side = (wanted & Qt::AlignHCenter) != 0 ? Qt::AlignHCenter : Qt::AlignRight;
    for (const Line& line : lines) {
      painter.drawText(
          QRectF(room.left(), top, room.width(), line.height),
          static_cast<int>(side | Qt::AlignAbsolute | Qt::AlignVCenter) | Qt::TextForceRightToLeft,
          line.words);
      top += line.height;
    }
  }
};

}  // namespace

void wrap_words(QLabel& label) {
  label.setWordWrap(true);
  label.installEventFilter(new LinesFromTheRight(&label));
}

void align_trailing(QLabel& label) {
  const bool mirrored = QLocale().textDirection() == Qt::RightToLeft;
  label.setAlignment(Qt::AlignAbsolute | Qt::AlignVCenter | (mirrored ? Qt::AlignLeft : Qt::AlignRight));
}

void turn_with_focus_only(QWidget& widget) {
  widget.setFocusPolicy(Qt::StrongFocus);  // not by the wheel
  widget.installEventFilter(new WheelWithFocus(&widget));
}

void SpeakingWidget::says(std::function<void()> say) {
  say();
  sayings_.push_back(std::move(say));
}

void SpeakingWidget::changeEvent(QEvent* event) {
  if (event->type() == QEvent::LanguageChange)
    for (const auto& say : sayings_) say();
  QWidget::changeEvent(event);
}

Card::Card(QWidget* parent) : QFrame(parent), column_(new QVBoxLayout(this)) {
  setProperty("card", true);
  column_->setContentsMargins(16, 13, 16, 15);
  column_->setSpacing(9);
}

QLabel* make_label(const char* role, QWidget* parent) {
  auto* label = new QLabel(parent);
  label->setProperty("role", QString::fromLatin1(role));
  return label;
}

void set_role(QWidget* widget, const char* property, const QString& value) {
  if (widget->property(property).toString() == value) return;
  widget->setProperty(property, value);
  widget->style()->unpolish(widget);
  widget->style()->polish(widget);
}

void speak_direction(QSlider& slider) {
  set_role(&slider, "mirrored",
           QLocale().textDirection() == Qt::RightToLeft ? QStringLiteral("true") : QString());
}

QPushButton* make_button(const Theme& theme, const QString& icon, const char* kind, QWidget* parent) {
  auto* button = new IconButton(theme, parent);
  button->setProperty("kind", QString::fromLatin1(kind));
  button->setAutoDefault(false);
  const auto colour_icon = [button, icon, &theme, primary = QLatin1String(kind) == QLatin1String("primary"),
                            danger = QLatin1String(kind) == QLatin1String("danger")] {
    if (icon.isEmpty()) return;
    button->setIcon(theme.icon(icon, primary  ? theme.colours().accent_text
                                     : danger ? theme.colours().danger
                                              : QColor()));
    button->setIconSize({17, 17});
  };
  colour_icon();
  QObject::connect(&theme, &Theme::changed, button, colour_icon);
  return button;
}

QToolButton* make_tool(const Theme& theme, const QString& icon, bool checkable, QWidget* parent) {
  auto* button = new QToolButton(parent);
  button->setCheckable(checkable);
  button->setIconSize({20, 20});
  button->setFocusPolicy(Qt::TabFocus);
  const auto colour_icon = [button, icon, &theme] { button->setIcon(theme.icon(icon)); };
  colour_icon();
  QObject::connect(&theme, &Theme::changed, button, colour_icon);
  return button;
}

void IconButton::paintEvent(QPaintEvent*) {
  QStyleOptionButton option;
  initStyleOption(&option);
  const QString words = option.text;
  const QIcon picture = option.icon;
  option.text.clear();
  option.icon = {};
  QStylePainter painter(this);
  painter.drawControl(QStyle::CE_PushButton, option);
  const QString kind = property("kind").toString();
  const ThemeColours& colours = theme_.colours();
  const QColor colour = !isEnabled()                       ? colours.muted
                        : kind == QLatin1String("primary") ? colours.accent_text
                        : kind == QLatin1String("danger")  ? colours.danger
                                                           : colours.text;
  const int icon_room = picture.isNull() ? 0 : iconSize().width() + (words.isEmpty() ? 0 : 7);
  const int words_room = fontMetrics().horizontalAdvance(words);
  const int left = (width() - icon_room - words_room) / 2;
  const bool mirrored = layoutDirection() == Qt::RightToLeft;
  if (!picture.isNull())
    picture.paint(&painter,
                  QRect(mirrored ? left + words_room + icon_room - iconSize().width() : left,
                        (height() - iconSize().height()) / 2, iconSize().width(), iconSize().height()),
                  Qt::AlignCenter, isEnabled() ? QIcon::Normal : QIcon::Disabled);
  painter.setPen(colour);
  painter.drawText(QRect(mirrored ? left : left + icon_room, 0, words_room + 2, height()),
                   Qt::AlignVCenter | Qt::AlignLeft | Qt::AlignAbsolute, words);
}

void set_usable(QAbstractButton& button, bool can, const QString& why_not) {
  constexpr const char* kOwn = "own_tip";
  constexpr const char* kWhy = "why_not";
  // What it does, unless the tip is a reason of before: it may have been said anew in another language.
  const QString shown = button.property(kWhy).toString();
  if (shown.isEmpty() || button.toolTip() != shown) button.setProperty(kOwn, button.toolTip());
  const QString why = can ? QString() : why_not;
  if (why != shown) button.setProperty(kWhy, why);
  const QString tip = why.isEmpty() ? button.property(kOwn).toString() : why;
  if (tip != button.toolTip()) button.setToolTip(tip);
  button.setEnabled(can);
}

void ElidedLabel::set_text(const QString& text) {
  if (text == this->text()) return;
  setText(text);
  setToolTip(text);
}

QSize ElidedLabel::minimumSizeHint() const {
  return {20, QLabel::minimumSizeHint().height()};
}

void ElidedLabel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setPen(palette().color(foregroundRole()));
  const QRect room = contentsRect();
  painter.drawText(room, static_cast<int>(QStyle::visualAlignment(layoutDirection(), alignment())),
                   fontMetrics().elidedText(text(), Qt::ElideRight, room.width()));
}

}  // namespace kinebus::gui
