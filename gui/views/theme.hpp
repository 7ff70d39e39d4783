#pragma once
// Light and dark: colours by what they are for, the palette and the style sheet made of them, and icons in
// them.

#include <QColor>
#include <QIcon>
#include <QObject>
#include <QString>

#include "gui/models/state_words.hpp"
#include "gui/scene/scene_renderer.hpp"

namespace kinebus::gui {

struct ThemeColours {
  QColor window, card, raised, border, text, muted, accent, accent_text, hover, selection;
  QColor danger, danger_text, good, waiting, busy;
};

class Theme : public QObject {
  Q_OBJECT
 public:
  using QObject::QObject;
  void apply(bool dark);
  bool dark() const { return dark_; }
  const ThemeColours& colours() const { return colours_; }
  QColor tone(StateTone tone) const;
  SceneColours scene() const;
  /// A drawing of gui/icons in the text's colour, or in `colour`.
  QIcon icon(const QString& name, const QColor& colour = {}) const;

 signals:
  void changed();

 private:
  QString style_sheet() const;
  bool dark_ = false;
  ThemeColours colours_;
};

}  // namespace kinebus::gui
