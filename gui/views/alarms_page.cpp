#include "gui/views/alarms_page.hpp"

#include <QAbstractItemModel>
#include <QAbstractItemView>
#include <QCheckBox>
#include <QColor>
#include <QFont>
#include <QFontMetrics>
#include <QHBoxLayout>
#include <QLabel>
#include <QModelIndex>
#include <QPaintEvent>
#include <QPainter>
#include <QPushButton>
#include <QRect>
#include <QSize>
#include <QSortFilterProxyModel>
#include <QStyle>
#include <QStyleOptionViewItem>
#include <QStyledItemDelegate>
#include <QVBoxLayout>
#include <QWidget>

namespace kinebus::gui {
namespace {

/// Of what has happened: alarms, or all of it.
class AlarmsAlone : public QSortFilterProxyModel {
 public:
  using QSortFilterProxyModel::QSortFilterProxyModel;
  void let_all_in(bool all) {
    all_ = all;
    invalidateFilter();
  }

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override {
    return all_ || sourceModel()->index(row, 0, parent).data(EventsModel::kIsAlarm).toBool();
  }

 private:
  bool all_ = false;
};

class EventDelegate : public QStyledItemDelegate {
 public:
  EventDelegate(const Theme& theme, QObject* parent) : QStyledItemDelegate(parent), theme_(theme) {}

  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    const int lines = index.data(EventsModel::kAdvice).toString().isEmpty() ? 2 : 3;
    return {200, option.fontMetrics.height() * lines + 22};
  }

  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing);
    const ThemeColours& colours = theme_.colours();
    const bool alarm = index.data(EventsModel::kIsAlarm).toBool(),
               mirrored = option.direction == Qt::RightToLeft;
    if ((option.state & QStyle::State_Selected) != 0) painter->fillRect(option.rect, colours.selection);
    const QColor mark = alarm ? colours.danger : colours.muted;
    QRect room = option.rect.adjusted(14, 8, -14, -8);
    const QRect bar(mirrored ? room.right() - 3 : room.left(), room.top() + 2, 4, room.height() - 4);
    painter->setPen(Qt::NoPen);
    painter->setBrush(mark);
    painter->drawRoundedRect(bar, 2, 2);
    mirrored ? room.adjust(0, 0, -16, 0) : room.adjust(16, 0, 0, 0);
    const int height = option.fontMetrics.height();
    // The painter would turn left and right round once more.
    const auto leading = Qt::AlignAbsolute | (mirrored ? Qt::AlignRight : Qt::AlignLeft),
               trailing = Qt::AlignAbsolute | (mirrored ? Qt::AlignLeft : Qt::AlignRight);
    const QString when = index.data(EventsModel::kWhen).toString();
    painter->setPen(colours.muted);
    painter->drawText(QRect(room.left(), room.top(), room.width(), height), static_cast<int>(trailing), when);
    QFont bold = option.font;
    bold.setWeight(QFont::DemiBold);
    painter->setFont(bold);
    painter->setPen(alarm ? colours.danger : colours.text);
    const int taken = option.fontMetrics.horizontalAdvance(when) + 20;
    const QRect title(mirrored ? room.left() + taken : room.left(), room.top(), room.width() - taken, height);
    painter->drawText(title, static_cast<int>(leading),
                      QFontMetrics(bold).elidedText(index.data(EventsModel::kTitle).toString(),
                                                    Qt::ElideRight, title.width()));
    painter->setFont(option.font);
    int y = room.top() + height + 2;
    const auto line = [&](const QString& text, const QColor& colour) {
      painter->setPen(colour);
      painter->drawText(QRect(room.left(), y, room.width(), height), static_cast<int>(leading),
                        option.fontMetrics.elidedText(text, Qt::ElideRight, room.width()));
      y += height + 2;
    };
    line(index.data(EventsModel::kDetails).toString(), colours.muted);
    if (const QString advice = index.data(EventsModel::kAdvice).toString(); !advice.isEmpty())
      line(advice, colours.text);
    painter->restore();
  }

 private:
  const Theme& theme_;
};

/// Says so where there is nothing to list.
class EventList : public QListView {
 public:
  EventList(const Theme& theme, QWidget* parent) : QListView(parent), theme_(theme) {}
  void say_of_nothing(const QString& words) {
    nothing_ = words;
    viewport()->update();
  }

 protected:
  void paintEvent(QPaintEvent* event) override {
    QListView::paintEvent(event);
    if (model() == nullptr || model()->rowCount() > 0) return;
    QPainter painter(viewport());
    painter.setPen(theme_.colours().muted);
    painter.drawText(viewport()->rect().adjusted(14, 14, -14, -14),
                     static_cast<int>(Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap), nothing_);
  }

 private:
  const Theme& theme_;
  QString nothing_;
};

}  // namespace

AlarmsPage::AlarmsPage(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(14, 12, 14, 12);
  column->setSpacing(12);
  open_ = new Card(this);
  title_ = make_label("title", open_);
  details_ = make_label("muted", open_);
  advice_ = new QLabel(open_);
  for (QLabel* label : {title_, details_, advice_}) wrap_words(*label);
  clear_ = make_button(desk_.theme, QStringLiteral("clear"), "primary", open_);
  auto* row = new QHBoxLayout;
  auto* words = new QVBoxLayout;
  words->setSpacing(5);
  words->addWidget(title_);
  words->addWidget(details_);
  words->addWidget(advice_);
  row->addLayout(words, 1);
  row->addWidget(clear_, 0, Qt::AlignBottom);
  open_->column()->addLayout(row);
  fine_ = make_label("muted", this);
  everything_ = new QCheckBox(this);
  shown_ = new AlarmsAlone(this);
  shown_->setSourceModel(&desk_.events);
  auto* list = new EventList(desk_.theme, this);
  list_ = list;
  list_->setModel(shown_);
  list_->setItemDelegate(new EventDelegate(desk_.theme, list_));
  list_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  list_->setUniformItemSizes(false);
  column->addWidget(open_);
  auto* head = new QHBoxLayout;
  head->addWidget(fine_);
  head->addStretch(1);
  head->addWidget(everything_);
  column->addLayout(head);
  column->addWidget(list_, 1);
  connect(clear_, &QPushButton::clicked, &desk_.session, &Session::clear);
  connect(everything_, &QCheckBox::toggled, this,
          [this](bool all) { static_cast<AlarmsAlone*>(shown_)->let_all_in(all); });
  connect(&desk_.events, &EventsModel::open_alarms_changed, this, &AlarmsPage::take);
  connect(&desk_.events, &QAbstractItemModel::rowsInserted, this, &AlarmsPage::take);
  connect(&desk_.session, &Session::status_changed, this, &AlarmsPage::take);
  says([this, list] {
    clear_->setText(tr("Clear"));
    fine_->setText(tr("No alarm is open."));
    everything_->setText(tr("Messages, too"));
    list_->setAccessibleName(tr("What has happened, newest first"));
    list->say_of_nothing(tr("No alarms so far."));
    desk_.events.retranslate();
    take();
  });
}

void AlarmsPage::take() {
  const auto state = desk_.session.status().state();
  const bool stopped = desk_.session.allowed(joblink::COMMAND_CLEAR);
  open_->setVisible(stopped);
  fine_->setVisible(!stopped);
  if (!stopped) return;
  QModelIndex newest;
  for (int i = 0; i < desk_.events.rowCount() && !newest.isValid(); ++i)
    if (desk_.events.index(i).data(EventsModel::kIsAlarm).toBool()) newest = desk_.events.index(i);
  const bool alarm = newest.isValid();
  title_->setText(alarm ? newest.data(EventsModel::kTitle).toString() : StateWords::title(state));
  details_->setText(alarm ? newest.data(EventsModel::kDetails).toString() : QString());
  details_->setVisible(alarm);
  advice_->setText(alarm ? newest.data(EventsModel::kAdvice).toString() : StateWords::next(state));
  title_->setStyleSheet(QStringLiteral("color: %1;").arg(desk_.theme.colours().danger.name()));
}

}  // namespace kinebus::gui
