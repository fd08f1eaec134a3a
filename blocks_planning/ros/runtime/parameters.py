"""Node parameters: declared once, with description, type and range."""

from __future__ import annotations

from typing import Any, NamedTuple

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node

from blocks_planning.errors import ConfigurationError, shown

_BY_ROS = ('use_sim_time', 'start_type_description_service')


class Parameter(NamedTuple):
    """A parameter; ``range`` is (least, most) for numbers. The type is that of the default."""

    name: str
    default: Any
    description: str
    range: tuple[float, float] | None = None

    def descriptor(self) -> ParameterDescriptor:
        """The description that ``ros2 param describe`` shows."""
        descriptor = ParameterDescriptor(description=self.description, read_only=True)
        if self.range is not None and isinstance(self.default, float):
            least, most = map(float, self.range)
            descriptor.floating_point_range = [
                FloatingPointRange(from_value=least, to_value=most, step=0.0)
            ]
        elif self.range is not None:
            least, most = map(int, self.range)
            descriptor.integer_range = [IntegerRange(from_value=least, to_value=most, step=1)]
        return descriptor


def declare(node: Node, parameters: tuple[Parameter, ...]) -> dict[str, Any]:
    """Declare a node's parameters and return their values.

    Raises:
        ConfigurationError: for an unknown parameter, or a value of the wrong type or out of
            range; the message names the node, the parameter and the value.
    """
    given = dict(node._parameter_overrides)  # noqa: SLF001  rclpy has no other way to see them
    known = [parameter.name for parameter in parameters]
    for name in given:
        if name not in known and name not in _BY_ROS and not name.startswith('qos_overrides.'):
            raise ConfigurationError(
                f'node {node.get_name()} has no parameter {shown(name)}; it has {", ".join(known)}'
            )
    return {parameter.name: _declare(node, parameter, given) for parameter in parameters}


def _declare(node: Node, parameter: Parameter, given: dict[str, Any]) -> Any:
    try:
        value = node.declare_parameter(
            parameter.name, parameter.default, parameter.descriptor()
        ).value
        # An empty list on the command line has no type, and arrives as a missing value.
        return [] if value is None and isinstance(parameter.default, list) else value
    except (InvalidParameterTypeException, InvalidParameterValueException):
        wanted = type(parameter.default).__name__
        if parameter.range is not None:
            wanted += f' from {parameter.range[0]} to {parameter.range[1]}'
        raise ConfigurationError(
            f'node {node.get_name()}: parameter {parameter.name} must be a {wanted}, '
            f'got {shown(given[parameter.name].value)}'
        ) from None
