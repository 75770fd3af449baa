from flight_stand_api_v1_pb2 import *
