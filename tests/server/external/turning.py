"""tests/server/external/turning.py: drives on slowly and turns the hand of an arm to 1 rad."""
import tautline


def update(seen):
    arm = seen.run.robot["arm"]
    if arm is None:
        return tautline.Answer(0.1, 0.0, joint_rates=[0.0] * 7)
    error = 1.0 - seen.joints[6]
    rate = max(-arm["rates"][6], min(arm["rates"][6], 2 * error))
    return tautline.Answer(0.1, 0.0, joint_rates=[0.0] * 6 + [rate])


tautline.drive(update)
