"""The whole graph, for ROS installations: ros2 launch blocks_planning trial.launch.py script:=...

All arguments are evaluated and checked before the first node starts, and each is a text, also if it
looks like a number. The launch ends when the orchestrator has run its script; it fails if the
orchestrator failed.
"""

from pathlib import Path

from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    OpaqueFunction,
    RegisterEventHandler,
)
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from launch import LaunchDescription

ARGUMENTS = {
    'script': ('', 'trial script to run; empty: wait for goals on run_trial'),
    'participant': ('', 'code of the person who plans; empty: as in the script'),
    'out_dir': ('trials', 'folder of trials.jsonl'),
    'bag_dir': ('', 'folder in which to record all topics as a bag; empty: no bag'),
    'namespace': ('', 'namespace of all nodes'),
    'peer_timeout_s': ('30.0', 'how long a node may be missing before its trial ends [s]'),
    'placing_timeout_s': ('30.0', 'how long the world may be silent before its trial ends [s]'),
    'retries': ('10', 'how often an order is given again that the world cannot carry out'),
    'markers': ('false', 'true: publish the towers for RViz and Foxglove'),
    'robot': ('false', 'true: a simulated robot carries out the orders (world observed)'),
    'view': ('false', 'true: serve the page; trial_view logs its address'),
}
NODES = ['world', 'subgoal_selector', 'action_searcher']
ROBOT_CELL_M = 0.04
FLAGS = {'true': True, 'false': False}


def flag(values, name):
    """Whether an argument is true."""
    if values[name] not in FLAGS:
        raise RuntimeError(f'{name} must be true or false, got {values[name]!r}')
    return FLAGS[values[name]]


def seconds(values, name):
    """An argument as a positive number."""
    try:
        number = float(values[name])
    except ValueError:
        number = 0.0
    if not 0 < number < float('inf'):
        raise RuntimeError(f'{name} must be a number of seconds above 0, got {values[name]!r}')
    return number


def count(values, name):
    """An argument as a whole number that is not negative."""
    if not values[name].isdecimal():
        raise RuntimeError(f'{name} must be a whole number from 0, got {values[name]!r}')
    return int(values[name])


def parameters_of(values):
    """The nodes to start, each with its parameters.

    Raises:
        RuntimeError: for an argument that cannot be used; naming it and its value.
    """
    if not values['out_dir']:
        raise RuntimeError("out_dir must be the name of a folder, got ''")
    session = {name: values[name] for name in ('script', 'participant')}
    found = {name: {} for name in NODES}
    found['world']['journal_dir'] = str(Path(values['out_dir'], 'journal'))
    if values['bag_dir']:
        found['bag_recorder'] = {'bag_dir': values['bag_dir']}
    if flag(values, 'markers'):
        found['marker_publisher'] = {}
    if flag(values, 'robot'):
        found['robot_arm'] = {'state_dir': str(Path(values['out_dir'], 'robot'))}
        found['world']['cell_size'] = ROBOT_CELL_M
    if flag(values, 'view'):
        found['trial_view'] = session
    found['trial_orchestrator'] = {
        **session,
        'out_dir': values['out_dir'],
        'wait_for': list(found),
        'peer_timeout_s': seconds(values, 'peer_timeout_s'),
        'placing_timeout_s': seconds(values, 'placing_timeout_s'),
        'retries': count(values, 'retries'),
    }
    return found


def start(context):
    """Start every node, with arguments that have been checked."""
    values = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    actions = []
    for name, parameters in parameters_of(values).items():
        node = Node(
            package='blocks_planning',
            executable=name,
            name=name,
            namespace=values['namespace'],
            output='screen',
            respawn=name not in ('trial_orchestrator', 'bag_recorder'),
            respawn_delay=0.5,
            parameters=[{key: typed(value) for key, value in parameters.items()}],
        )
        actions.append(node)
    ended = OnProcessExit(target_action=actions[-1], on_exit=after_orchestrator)
    return [*actions, RegisterEventHandler(ended)]


def typed(value):
    """A parameter as it is: a text stays a text, also one that reads like a number."""
    return ParameterValue(value, value_type=str) if isinstance(value, str) else value


def after_orchestrator(event, _):
    """End the launch; with an error, so that it fails, if the orchestrator failed."""
    if event.returncode:
        raise RuntimeError(f'trial_orchestrator ended with exit code {event.returncode}')
    return [EmitEvent(event=Shutdown(reason='the script is done'))]


def generate_launch_description():
    """The arguments, and what is done with them."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=start)])
