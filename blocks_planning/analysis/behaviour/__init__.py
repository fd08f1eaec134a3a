"""What people do beside what planners do, under the same measures: tables, figures, a section."""
