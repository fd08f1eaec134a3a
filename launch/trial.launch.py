"""The whole graph, for ROS installations: ros2 launch blocks_planning trial.launch.py script:=..."""

from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from launch import LaunchDescription

ARGUMENTS = {
    'script': ('', 'trial script to run; empty: wait for goals on run_trial'),
    'participant': ('', 'code of the person who scopes; empty: as the script says'),
    'out_dir': ('trials', 'folder of trials.jsonl'),
    'bag_dir': ('', 'folder of a bag to record everything in; empty: no bag'),
    'namespace': ('', 'namespace of all nodes'),
    'markers': ('false', 'true: show the towers to RViz and Foxglove'),
    'view': ('false', 'true: serve the page; trial_view says at which address'),
}
RESPAWNED = ('world', 'subgoal_selector', 'action_searcher')


def node(name: str, **options: object) -> Node:
    """A node of this package, in the namespace that was asked for."""
    return Node(
        package='blocks_planning',
        executable=name,
        name=name,
        namespace=LaunchConfiguration('namespace'),
        output='screen',
        **options,
    )


def text(argument: str) -> ParameterValue:
    """The value of an argument, as a text whatever it looks like."""
    return ParameterValue(LaunchConfiguration(argument), value_type=str)


def generate_launch_description() -> LaunchDescription:
    """Start every node; end when the orchestrator has run its script."""
    has_bag = PythonExpression(["'", LaunchConfiguration('bag_dir'), "' != ''"])
    peers = PythonExpression([str(list(RESPAWNED)), " + ['bag_recorder'] * ", has_bag])
    journal = [LaunchConfiguration('out_dir'), '/journal']
    orchestrator = node(
        'trial_orchestrator',
        parameters=[
            {
                'script': text('script'),
                'participant': text('participant'),
                'out_dir': text('out_dir'),
                'wait_for': peers,
            }
        ],
    )
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=default, description=description)
                for name, (default, description) in ARGUMENTS.items()
            ),
            *(node(name, respawn=True) for name in RESPAWNED if name != 'world'),
            node('world', respawn=True, parameters=[{'journal_dir': journal}]),
            node(
                'bag_recorder',
                parameters=[{'bag_dir': text('bag_dir')}],
                condition=IfCondition(has_bag),
            ),
            node(
                'marker_publisher',
                respawn=True,
                condition=IfCondition(LaunchConfiguration('markers')),
            ),
            node(
                'trial_view',
                respawn=True,
                parameters=[{'script': text('script'), 'participant': text('participant')}],
                condition=IfCondition(LaunchConfiguration('view')),
            ),
            orchestrator,
            RegisterEventHandler(
                OnProcessExit(target_action=orchestrator, on_exit=[EmitEvent(event=Shutdown())])
            ),
        ]
    )
