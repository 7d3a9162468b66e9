/* server/external/tautline_controller.h: a controller as a shared object, for C and C++
   (docs/external-controllers.md). Include it, define the five functions, build with -shared -fPIC,
   and give the file to `tautline run SCENARIO --controller ./mine.so`.

   Metres, radians, seconds; ccw positive. World frame W, robot frame R (x ahead, y left). Pointers
   that Tautline hands over are valid during the call; pointers that the controller hands over must be
   valid until its next call. */
#ifndef TAUTLINE_CONTROLLER_H
#define TAUTLINE_CONTROLLER_H

#include <stdint.h>

#define TAUTLINE_CONTROLLER_VERSION 1
#define TAUTLINE_JOINTS 7

#ifdef __cplusplus
extern "C" {
#endif

struct tautline_pose {
  double x, y, heading;
};
struct tautline_twist {
  double v, omega; /* [m/s], [rad/s] */
};

/* An arm (docs/arm.md). Of the joints, the shoulder's first. */
struct tautline_arm {
  double x, y, z, heading; /* of the shoulder, in R */
  double upper_arm, elbow_offset, forearm, hand; /* [m] */
  double limits[TAUTLINE_JOINTS]; /* [rad] to either side */
  double rates[TAUTLINE_JOINTS];  /* [rad/s] the fastest */
  double rest[TAUTLINE_JOINTS];   /* [rad] the folded pose */
};

/* The run that begins, and the robot: a rectangle if half_length is above 0, else a disc. */
struct tautline_run {
  const char* scenario;
  uint64_t seed; /* of the sensor noise; use it for your own randomness too */
  struct tautline_pose start;
  double radius, half_length, half_width, half_track;
  double period;                             /* [s] of a tick */
  double max_v, max_omega;                   /* [m/s], [rad/s] */
  double max_acceleration;                   /* [m/s2] */
  double max_angular_acceleration;           /* [rad/s2] */
  double command_delay;                      /* [s] from a command to its effect */
  int has_laser;                             /* if not, the sonar ring replaces the scan */
  uint32_t parameter_count;                  /* the values come with each observation */
  const char* const* parameter_names;
  const struct tautline_arm* arm; /* null if the robot has none */
};

struct tautline_reading {
  struct tautline_pose mount; /* in R */
  double stamp, range, range_max;
  uint8_t status; /* as of a beam */
};

struct tautline_observation {
  uint64_t tick; /* from 0 */
  double stamp;  /* [s] run clock */
  struct tautline_pose pose; /* by odometry, in W */
  struct tautline_twist twist;
  int has_goal; /* if not, the command moves nothing */
  int has_goal_heading;
  struct tautline_pose goal; /* in W */
  /* The filtered scan: beam i points at angle_min + i * angle_increment in the frame of `mount`. */
  int scan_fresh; /* new in this tick */
  double scan_stamp;
  struct tautline_pose mount; /* in R */
  double angle_min, angle_increment, range_max;
  uint32_t beams;
  const double* ranges;  /* [m] range_max where the status is not 0 */
  const uint8_t* status; /* 0: a distance, 1: nothing in range, 2: not measured */
  const double* parameters;
  uint32_t sonar_count, infrared_count;
  const struct tautline_reading* sonar;
  const struct tautline_reading* infrared;
  const double* joints;      /* [rad] measured; null without an arm */
  const double* joint_rates; /* [rad/s] */
};

/* kind: 0 points, 1 polyline, 2 arrows, 3 circles, 4 arcs; frame: 0 is W, 1 is R; positions are x y
   (web/telemetry.fbs says how the values of each kind are read). */
struct tautline_layer {
  const char* name;
  uint8_t kind, frame, tone, style;
  const float* values;
  uint32_t value_count;
};
struct tautline_measure {
  const char* name;
  const char* unit; /* may be null */
  double value;
};

/* All zero when update() is called. */
struct tautline_command {
  struct tautline_twist twist;
  int waits;        /* the robot may stand still now */
  uint8_t state;    /* your own; a change shows new words at once */
  const char* what; /* one sentence each; may be null */
  const char* why;
  const struct tautline_layer* layers;
  uint32_t layer_count;
  const struct tautline_measure* measures;
  uint32_t measure_count;
  int turns_joints; /* if not, the arm rests; a goal that people set for the arm comes first */
  double joint_rates[TAUTLINE_JOINTS]; /* [rad/s] */
};

/* Returns TAUTLINE_CONTROLLER_VERSION. */
uint32_t tautline_controller_version(void);
/* One controller for each run in progress, which may be on several threads. */
void* tautline_controller_make(void);
/* Forgets the previous run. */
void tautline_controller_reset(void* self, const struct tautline_run* run);
/* Returns 0; any other value ends the run, with `why` as the reason. */
int tautline_controller_update(void* self,
                               const struct tautline_observation* seen,
                               struct tautline_command* command);
void tautline_controller_free(void* self);

#ifdef __cplusplus
}
#endif

#endif
