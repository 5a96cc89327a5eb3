"""The environments, as Gymnasium checks them, and flown by the law."""

import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import slung
import slung.gym

NAME = "slung.gym:slung/Follow-v0"


def test_gymnasium_has_nothing_to_object_to():
    with warnings.catch_warnings():
        # Velocities have no bound to tell of.
        warnings.filterwarnings("ignore", message=".*(infinity|unbounded).*")
        check_env(gymnasium.make(NAME).unwrapped)


def test_the_law_earns_nearly_all_and_doing_nothing_little():
    env = gymnasium.make(NAME)
    rig = slung.Rig(slung.Parameters(CTL_PERIOD=0.01))

    def episode(fly):
        env.reset(seed=7)
        rig.take_over(env.unwrapped.state, 3.0 * 9.81)
        earned, ended = 0.0, False
        while not ended:
            _, reward, terminated, truncated, info = env.step(fly())
            earned += reward
            ended = terminated or truncated
        return earned, info["distance_m"]

    def law():
        output = rig.step(env.unwrapped.state, "follow")
        return env.unwrapped.action_of(output.thrust, output.torque)

    flown, distance = episode(law)
    # 20 s at most, of which joining costs some.
    assert 17.0 < flown < 20.0 and distance < 0.02
    idle, _ = episode(lambda: np.zeros(4, np.float32))
    assert idle < 0.8 * flown


def test_many_fly_as_one_does():
    many = gymnasium.make_vec(NAME, num_envs=3, vectorization_mode="vector_entry_point")
    one = gymnasium.make(NAME)
    first, _ = many.reset(seed=11)
    alone, _ = one.reset(seed=12)
    np.testing.assert_array_equal(first[1], alone)
    actions = 0.05 * np.random.default_rng(0).standard_normal((50, 3, 4)).astype(np.float32)
    for action in actions:
        observed, reward, *_ = many.step(action)
        alone, earned, *_ = one.step(action[1])
        np.testing.assert_array_equal(observed[1], alone)
        assert reward[1] == earned


def test_what_has_ended_begins_anew_at_the_next_step():
    many = gymnasium.make_vec(NAME, num_envs=2, vectorization_mode="vector_entry_point")
    begun, _ = many.reset(seed=1)
    # The one falls, the other climbs a little.
    actions = np.array([[-1, 0, 0, 0], [0.001, 0, 0, 0]], np.float32)
    for _ in range(1000):
        _, _, terminated, truncated, _ = many.step(actions)
        if terminated.any():
            break
    assert terminated.tolist() == [True, False] and not truncated.any()
    observed, reward, terminated, *_ = many.step(actions)
    assert reward[0] == 0.0 and not terminated[0]
    # Another flight of the same campaign.
    assert np.abs(observed[0]).max() < 10 and (observed[0] != begun[0]).any()


def test_bad_actions_are_refused():
    env = gymnasium.make(NAME).unwrapped
    env.reset(seed=1)
    with pytest.raises(slung.Refused, match="not a number"):
        env.step(np.full(4, np.nan))
    with pytest.raises(ValueError, match="lost_m = 0"):
        slung.gym.FollowEnv(lost_m=0.0)
