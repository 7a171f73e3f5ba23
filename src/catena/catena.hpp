// All public headers of Catena.
#pragma once

#include "catena/errors.hpp"
#include "catena/forces.hpp"
#include "catena/scene.hpp"
#include "catena/simulation.hpp"
#include "catena/solver.hpp"
#include "catena/types.hpp"
#include "catena/version.hpp"
