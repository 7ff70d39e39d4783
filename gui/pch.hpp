#pragma once
// What nearly every file of the desktop program needs, compiled once.
#include <QtCore/QtCore>
#include <QtGui/QtGui>
#include <QtWidgets/QtWidgets>
