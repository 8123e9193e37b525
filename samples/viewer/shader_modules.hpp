// SPIR-V of the passes, embedded by the build.
#pragma once
#include "finish.comp.h"
#include "light.comp.h"
#include "prepare.comp.h"
#include "reduce.comp.h"
#include "see.comp.h"
#include "shade.comp.h"
#include "slopes.comp.h"
#include "summit.comp.h"
