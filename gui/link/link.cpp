#include "gui/link/link.hpp"  // its signals need a home
