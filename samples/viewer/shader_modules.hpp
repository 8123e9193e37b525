// SPIR-V of the passes, embedded by the build.
#pragma once
#include "viewer_shaders/bake.comp.h"
#include "viewer_shaders/finish.comp.h"
#include "viewer_shaders/light.comp.h"
#include "viewer_shaders/prepare.comp.h"
#include "viewer_shaders/reduce.comp.h"
#include "viewer_shaders/see.comp.h"
#include "viewer_shaders/shade.comp.h"
#include "viewer_shaders/slopes.comp.h"
#include "viewer_shaders/summit.comp.h"
