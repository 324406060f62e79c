"""Foundations of all layers: errors, checks, units, results and their labels, files, figures.

Arguments enter through :mod:`.checks` and :mod:`.quantities`, which give float64 in the unit of the
argument or raise an exception of :mod:`.errors`.  :mod:`.scale` has the unit and the symbol of
every quantity.  Results leave through :mod:`.results`, :mod:`.labels` and :mod:`.plots`, files
through :mod:`.files`; :mod:`.blocks` divides arrays among threads.
"""

from .blocks import block_reader, broadcast_vector, cancel_with, run_blocks, thread_count
from .checks import (
    Booleans,
    Floats,
    Integers,
    Numbers,
    broadcast_shape,
    check_array,
    check_array_extent,
    check_bool,
    check_choice,
    check_integer,
    check_number,
    check_text,
    divide_by_unit,
    extent,
    read_only,
)
from .drive_arguments import (
    Feedback,
    Schedule,
    make_dimensionless,
    require_time_argument,
    slope_tan_cos,
)
from .errors import (
    ConvergenceError,
    FileError,
    Interrupted,
    MissingDependencyError,
    ModelWarning,
    MotionStatus,
    OutOfTableError,
    ParameterError,
    ViscorollError,
    caller_level,
    check_names,
    check_one_given,
    describe_value,
    described_error,
    digits_beside,
    exactly_one_error,
    import_extra,
    mark_dimensionless,
    shape_error,
    suggestion,
    unknown_name_error,
    warn_of_model,
)
from .files import (
    as_file_error,
    as_path,
    fix_texts,
    load_kept,
    read_sealed,
    replace_file,
    save_kept,
    seal,
    seal_matches,
    write_bytes,
    write_dataset,
    write_text,
)
from .labels import UNLABELLED_TYPES, Labels, dataset_axes, strip_labels
from .quantities import conversion_factor, is_real, is_unit, to_unit
from .results import (
    Result,
    SummaryRow,
    Values,
    as_html,
    as_text,
    column_name,
    format_value,
    unit_of,
)
from .scale import (
    DIMENSIONLESS,
    DIMENSIONS,
    MEASURED,
    PAPER,
    SI,
    SYMBOLS,
    TIME_POWERS,
    HasUnits,
    Scale,
    Units,
    attributes,
    dimension_powers,
    si_unit,
)
